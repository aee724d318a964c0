#pragma once
// A log as a .npz archive of NumPy: one array per quantity, with the shape rows x columns, or only
// rows where the quantity is one number. The array "joints" names the joints, and "about" is JSON:
// shape, unit and columns of every array, and from what the run was made. No array needs pickle.
// The archive is not compressed.

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
