#pragma once
// The sheet of a sign test: one picture per joint that shows which way it has to move.

#include "ayumi/io/formats/sign_test.hpp"
#include "ayumi/render/image.hpp"

namespace ayumi::app {

/// The home posture pale, and the joint moved in full colour. The motion is drawn larger than it
/// is; the caption says how much.
Image sign_test_picture(const RobotModel& model, const SignTest& test);

/// A page with the pictures, which are beside it as <name>.png, and what each file has to do.
/// `extension` is that of the tables.
std::string sign_test_page(const RobotModel& model, const std::vector<SignTest>& tests,
                           const std::string& extension);

}  // namespace ayumi::app
