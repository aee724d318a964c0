#pragma once
// A table of numbers with named columns, and with "# key: value" lines above. Joint tables of every
// text format are read as such a table.

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

namespace ayumi {

struct NumberTable {
  std::map<std::string, std::string> header;
  std::vector<std::string> columns;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values;

  /// Index of a column; -1 if there is none.
  int find(const std::string& column) const;
};

/// Reads comma-separated numbers under one head row, with "#" lines before it. Blank lines are
/// skipped. Throws Error(bad_file) "file:line: ..." if there is no head row or no data row, for a
/// repeated or empty column name, for a row of another length, and for a cell that is not a finite
/// number.
NumberTable parse_csv(const std::string& bytes, const std::string& file);

}  // namespace ayumi
