#pragma once
// The uncertainty of a robot whose files state none: the usual ranges of small humanoid robots,
// scaled to this one. Every distribution is marked as assumed.

#include "ayumi/io/pattern/study_file.hpp"

namespace ayumi {

/// The uncertainty as a study file, which can be written and edited.
std::string assumed_study_text(const RobotModel& robot);

/// The uncertainty of assumed_study_text() after reading. Its file name says that it is assumed.
Study assumed_study(const RobotModel& robot);

}  // namespace ayumi
