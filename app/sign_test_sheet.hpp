#pragma once
// The sheet of a sign test. It has one picture for each joint that shows in which direction the
// joint has to move.

#include "ayumi/io/formats/sign_test.hpp"
#include "ayumi/render/image.hpp"

namespace ayumi::app {

/// A sentence that says whether a joint with a wrong sign jumps when a test begins. If all joints
/// begin at 0, none does.
std::string sign_test_words(const RobotModel& model, const std::vector<SignTest>& tests);

/// The side of the robot from which the picture of the test shows it, such as "left".
std::string sign_test_view(const RobotModel& model, const SignTest& test);

/// The first posture in pale colours, and the moved joint in full colour. The motion is drawn
/// larger than it is; the caption states the factor.
Image sign_test_picture(const RobotModel& model, const SignTest& test);

/// A page with the pictures, which are beside it as <name>.png, and the motion that each file
/// makes. `extension` is that of the tables.
std::string sign_test_page(const RobotModel& model, const std::vector<SignTest>& tests,
                           const std::string& extension);

}  // namespace ayumi::app
