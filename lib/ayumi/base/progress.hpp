#pragma once
// Progress of long work: how the work reports its state to the caller, and how the caller stops the
// work.

#include <functional>
#include <string>

#include "ayumi/base/error.hpp"

namespace ayumi {

struct ProgressEvent {
  std::string stage;    ///< what is being done, e.g. "simulate"
  double fraction = 0;  ///< done share of this stage, 0..1; negative when unknown
  std::string detail;   ///< free text, may be empty
};

/// Returns false to stop the work. An empty function means "nobody is watching".
using Progress = std::function<bool(const ProgressEvent&)>;

/// Reports to `progress`; throws Interrupted when it returns false.
inline void report(const Progress& progress, const ProgressEvent& event) {
  if (progress && !progress(event)) throw Interrupted();
}

}  // namespace ayumi
