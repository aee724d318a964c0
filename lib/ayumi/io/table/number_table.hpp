#pragma once
// A table of numbers with named columns and "# key: value" lines above: what joint tables are made
// of, whichever text carries them.

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

namespace ayumi {

struct NumberTable {
  std::map<std::string, std::string> header;
  std::vector<std::string> columns;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> values;

  /// Index of a column; -1 when there is none.
  int find(const std::string& column) const;
};

/// Comma-separated numbers under one head row; "#" lines before it. Blank lines are skipped. Throws
/// Error(bad_file) "file:line: ..." for no head row, no data row, a repeated or empty column name,
/// a row of another length, a cell that is not a finite number.
NumberTable parse_csv(const std::string& bytes, const std::string& file);

}  // namespace ayumi
