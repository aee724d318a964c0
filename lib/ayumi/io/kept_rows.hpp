#pragma once
// A pattern that was imported from a sequence and still moves like this sequence. For such a
// pattern, `export` writes the original rows of the sequence, and not rows that are computed from
// the motion.

#include <optional>
#include <string>

#include "ayumi/io/formats/hoap.hpp"
#include "ayumi/task/task.hpp"

namespace ayumi {

struct KeptRows {
  HoapFile file;
  std::string bytes;            ///< rows of the file
  ReferenceTrajectory targets;  ///< targets that the servos receive
};

/// The rows of the sequence from which the pattern was imported. Returns nothing if there was no
/// sequence, if the motion was changed, or if the encoders of the robot are not those with which
/// the sequence was read. Throws Error(bad_file) if the kept sequence is missing or was changed.
std::optional<KeptRows> kept_rows(const Task& task);

/// The unchanged rows of the pattern's table, if the pattern still moves as its table does. Values
/// of COG, ZMP, force and contacts that the table does not have come from `planned`. Returns
/// nothing if the pattern has no table or was changed.
std::optional<ReferenceTrajectory> rows_of_table(const Task& task,
                                                 const ReferenceTrajectory& planned);

}  // namespace ayumi
