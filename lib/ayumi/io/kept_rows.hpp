#pragma once
// A pattern that was imported from a sequence and still moves as it: `export` writes the rows of
// the sequence as they were, in place of rows computed of the motion.

#include <optional>
#include <string>

#include "ayumi/io/formats/hoap.hpp"
#include "ayumi/task/task.hpp"

namespace ayumi {

struct KeptRows {
  HoapFile file;
  std::string bytes;            ///< of the file
  ReferenceTrajectory targets;  ///< what the servos receive
};

/// The rows of the sequence that the pattern was imported from; nothing where there was none or the
/// motion was changed. Throws Error(bad_file) where the kept sequence is missing or was changed.
std::optional<KeptRows> kept_rows(const Task& task);

/// The rows of the pattern's table as they are, as long as the pattern moves as its table does;
/// COG, ZMP, force and contacts of `planned` where the table has none. Nothing where the pattern
/// has no table or was changed.
std::optional<ReferenceTrajectory> rows_of_table(const Task& task,
                                                 const ReferenceTrajectory& planned);

}  // namespace ayumi
