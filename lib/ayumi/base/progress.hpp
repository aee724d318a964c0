#pragma once
// Progress of long work: how the work reports its state to the caller, and how the caller stops the
// work.

#include <functional>
#include <string>

#include "ayumi/base/error.hpp"

namespace ayumi {

struct ProgressEvent {
  std::string stage;  ///< name of the stage, for people, such as "simulating with dtad"
  /// Fraction of this stage that is done, from 0 to 1; negative if it is unknown.
  double fraction = 0;
  std::string detail;  ///< free text, may be empty
};

/// Returns false to stop the work. An empty function means "nobody is watching".
using Progress = std::function<bool(const ProgressEvent&)>;

/// Reports to `progress`. Throws Interrupted if it returns false.
inline void report(const Progress& progress, const ProgressEvent& event) {
  if (progress && !progress(event)) throw Interrupted();
}

}  // namespace ayumi
