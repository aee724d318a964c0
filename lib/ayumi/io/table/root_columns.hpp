#pragma once
// The columns of a table that hold the motion of the root, as programs other than Ayumi name them:
// root_x and root_qw, base_pos_x and base_quat_w, pose.position.x and pose.orientation.w, x and qw.

#include <functional>
#include <string>
#include <vector>

#include "ayumi/io/table/number_table.hpp"

namespace ayumi {

/// Gives the seven columns of the root's place and quaternion the names of kBaseColumns, and says
/// so in `notes`. Places in cm or mm become metres. A table without these seven columns, or with
/// kBaseColumns, stays as it is. A column for which `is_joint` is true belongs to a joint. Throws
/// Error(bad_file) if two groups of columns may be the root.
void name_root_columns(NumberTable& table, const std::string& file,
                       const std::function<bool(const std::string&)>& is_joint,
                       std::vector<std::string>& notes);

}  // namespace ayumi
