#pragma once
// The names of the columns of joint tables, and their groups.

#include <filesystem>
#include <optional>
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

/// The name "theta.<joint>[rad]" of a joint's column, and the joint that such a name contains;
/// empty if the column does not have such a name.
std::string theta_column(const std::string& joint);
std::string joint_of_column(const std::string& column);

/// A column's name, and its unit in small letters, as in "r_knee[deg]", "r_knee (deg)",
/// "r_knee_DEG" and "time_ms"; the unit is empty if the column has none.
struct ColumnName {
  std::string name, unit;
};
ColumnName column_name(const std::string& column);

/// The seconds of one unit of a column of times ("t[s]", "Time (ms)"); nothing for other columns,
/// and for times in an unknown unit.
std::optional<double> seconds_of_time_column(const std::string& column);
/// Whether it is a column of times, in whatever unit.
bool is_time_column(const std::string& column);

/// The place of each group of columns in a table: its first index, or -1 if it is absent. Throws
/// Error(bad_file) for an unknown column, for a group without all of its members, and without t[s].
struct TableLayout {
  int time = -1, fz = -1;
  std::vector<std::string> joints;
  std::vector<int> theta;  ///< index of the column of each joint
  /// Index of each column of the group; empty if it is absent.
  std::vector<int> cog, zmp, base, contact;
};
TableLayout layout_of(const NumberTable& table, const std::string& file);

/// Whether theta are servo targets: the table is a reference table, or its header says "theta:
/// commands".
bool holds_commands(const NumberTable& table);

/// The text of a header line. It is quoted as in JSON if it is not plain text.
std::string read_header_value(const std::string& text);

/// The zeros of the encoders that the head states (`servo_offset`), one for each joint of the
/// layout [rad, m]; empty if it states none. The angle of a joint is the value in the table plus
/// its zero (model/encoder_angles). Throws Error(bad_file) if there is another number of zeros.
Eigen::VectorXd zeros_of(const NumberTable& table, const TableLayout& layout,
                         const std::string& file);

/// The caution in the header about the run from which the table comes ("disturbances", "unfit").
TableCaution caution_of(const NumberTable& table);

/// The dt of a table whose rows are at k dt: the header's "dt", or else the step of the time
/// column. Throws Error(bad_file) that names the row for a time that is not k dt.
double tick_of(const NumberTable& table, const TableLayout& layout, const std::string& file);

/// The base pose of a row. Throws Error(bad_file) if its quaternion is not unit (1e-6).
BasePose base_of(const NumberTable& table, const TableLayout& layout, Eigen::Index row,
                 const std::string& file);

/// Reads CSV or JSON (with "columns", "data" and the other keys as header); the first character
/// shows which one it is.
NumberTable number_table(const std::string& bytes, const std::string& file);
NumberTable read_number_table(const std::filesystem::path& path);

}  // namespace ayumi
