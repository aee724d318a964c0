#pragma once
// The names of the columns of joint tables, and their groups.

#include <filesystem>
#include <string>
#include <vector>

#include "ayumi/io/table/number_table.hpp"
#include "ayumi/model/robot_state.hpp"
#include "ayumi/motion/table_caution.hpp"

namespace ayumi {

inline constexpr const char* kReferenceFormat = "ayumi.reference/1";
inline constexpr const char* kMotionFormat = "ayumi.motion/1";
inline const std::vector<std::string> kCogColumns = {"cog.x[m]", "cog.y[m]", "cog.z[m]"};
inline const std::vector<std::string> kZmpColumns = {"zmp.x[m]", "zmp.y[m]", "zmp.z[m]"};
inline const std::vector<std::string> kBaseColumns = {
    "base.x[m]", "base.y[m]", "base.z[m]", "base.qw", "base.qx", "base.qy", "base.qz"};
inline const std::vector<std::string> kContactColumns = {"contact.left", "contact.right"};

/// The name "theta.<joint>[rad]" of a joint's column, and the joint of such a name; empty when the
/// column is not one.
std::string theta_column(const std::string& joint);
std::string joint_of_column(const std::string& column);

/// Where each group of columns stands in a table: first index, or -1 when it is absent. Throws
/// Error(bad_file) for an unknown column, for a group without all of its members, and without t[s].
struct TableLayout {
  int time = -1, fz = -1;
  std::vector<std::string> joints;
  std::vector<int> theta;                    ///< one index per joint
  std::vector<int> cog, zmp, base, contact;  ///< one index per column of the group, or empty
};
TableLayout layout_of(const NumberTable& table, const std::string& file);

/// Whether theta is what servos receive: a reference table, or the header says theta: commands.
bool holds_commands(const NumberTable& table);

/// The text of a header line, which is quoted as in JSON where it is not plain.
std::string read_header_value(const std::string& text);

/// What the header says of the run that the table is from ("disturbances", "unfit").
TableCaution caution_of(const NumberTable& table);

/// dt of a table whose rows are k dt: the header's "dt", or else from the time column. Throws
/// Error(bad_file) for a time that is not k dt, naming the row.
double tick_of(const NumberTable& table, const TableLayout& layout, const std::string& file);

/// Base pose of a row; throws Error(bad_file) unless the quaternion is unit (1e-6).
BasePose base_of(const NumberTable& table, const TableLayout& layout, Eigen::Index row,
                 const std::string& file);

/// Reads CSV or JSON ("columns", "data" and the other keys as header), as the first character says.
NumberTable number_table(const std::string& bytes, const std::string& file);
NumberTable read_number_table(const std::filesystem::path& path);

}  // namespace ayumi
