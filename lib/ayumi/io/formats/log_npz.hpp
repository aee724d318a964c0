#pragma once
// A log as a .npz archive of NumPy. There is one array for each quantity. It has the shape rows x
// columns, or only rows if the quantity is one number. The array "joints" names the joints. The
// array "about" is JSON: shape, unit and columns of every array, and the origin of the run. No
// array needs pickle. The archive is not compressed.

#include <string>
#include <vector>

#include "ayumi/io/run/log_table.hpp"

namespace ayumi {

struct NpzArray {
  std::string name, unit;
  std::vector<size_t> shape;
};

/// The arrays that have numbers, in the order of the archive.
std::vector<NpzArray> npz_arrays(const LogTable& table);

std::string log_npz(const LogTable& table, const SimulationLog& log);

}  // namespace ayumi
