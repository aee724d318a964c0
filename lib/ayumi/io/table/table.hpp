#pragma once
// Joint tables that describe their content: ReferenceTrajectory as CSV and JSON
// ("ayumi.reference/1"), and the sampled motions that a pattern names. Columns and units as in
// docs/formats.md: t[s], theta.<joint>[rad], cog.x[m], zmp.x[m], fz[N], base.x[m], base.qw,
// contact.left.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/motion/pattern.hpp"
#include "ayumi/motion/reference_trajectory.hpp"
#include "ayumi/motion/table_caution.hpp"

namespace ayumi {

/// Writes "# key: value" lines, one head row, and one row for each tick; numbers read back to the
/// same bits. The head describes the run of the table. Throws Error(internal) for a value that is
/// not finite or a row with another number of joints.
std::string reference_csv(const ReferenceTrajectory& reference, const TableCaution& caution = {});
/// The columns and rows of reference_csv() as one JSON object.
std::string reference_json(const ReferenceTrajectory& reference, const TableCaution& caution = {});

/// The part of the head of a table that describes its run. Throws Error(bad_file) if the file is
/// not a table.
TableCaution read_table_caution(const std::filesystem::path& path);
TableCaution parse_table_caution(const std::string& bytes, const std::string& file);

/// Reads the text of reference_csv or reference_json; the first character shows which one it is.
/// Throws Error(bad_file) that names file and line or pointer for another format, missing or
/// unknown columns, rows of unequal length, times that are not k dt, quaternions that are not unit
/// (1e-6), and a table without rows.
ReferenceTrajectory read_reference(const std::filesystem::path& path);
ReferenceTrajectory parse_reference(const std::string& bytes, const std::string& file);

/// Throws Error(bad_file) unless the table's joints are exactly `joints`, in this order.
void require_joints(const ReferenceTrajectory& reference, const std::vector<std::string>& joints,
                    const std::string& file);

/// Reads the table of a pattern: t[s] and any whole group of the columns above. Contacts follow
/// from the phases of the pattern, so that contact columns are skipped. Time starts at 0 at a fixed
/// rate. Throws the same errors as read_reference().
DenseTable read_dense_table(const std::filesystem::path& path);
/// Fingerprint of the angles of a table. It shows whether they have changed since the import.
std::string theta_sha256(const DenseTable& table);
/// The text that read_dense_table() reads.
std::string dense_table_csv(const DenseTable& table, const TableCaution& caution = {});

}  // namespace ayumi
