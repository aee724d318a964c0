#include "robot_picture.hpp"

#include "ayumi/base/error.hpp"
#include "pattern_input.hpp"

namespace ayumi::app {

std::vector<std::string> write_robot_picture(const Context& context, const RobotModel& model,
                                             const std::string& file, const std::string& view) {
  if (std::filesystem::path(file).extension() != ".png")
    fail(ErrorCode::usage, "--picture " + file + ": --picture needs a file name that ends in .png");
  refuse_overwriting(context, file);
  const RobotPicture picture = draw_robot(model, view, false);
  write_png(file, picture.image);
  return picture.notes;
}

}  // namespace ayumi::app
