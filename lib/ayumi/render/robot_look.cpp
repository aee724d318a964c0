#include "ayumi/render/robot_look.hpp"

#include <algorithm>
#include <cmath>

#include "ayumi/base/text.hpp"
#include "ayumi/render/hidden_parts.hpp"
#include "ayumi/render/simplify.hpp"
#include "ayumi/render/thin.hpp"

namespace ayumi {
namespace {

/// Number of triangles of a robot above which not all of them can be seen. Chosen: two for each
/// pixel that a robot takes of a picture of 720 rows, of which one faces the eye. With half of the
/// value, models from robot makers would lose triangles; with twice, snapshots take twice as long.
constexpr size_t kMostTriangles = 200'000;
/// Number of rows of the picture in which a thinned robot looks like its meshes.
constexpr double kRows = 720;
/// Factor by which a tolerance grows if it left too many triangles, and the largest number of
/// times. Chosen: at four times the first tolerance, outlines have corners of one pixel.
constexpr double kGrowth = 2;
constexpr int kTrials = 3;

}  // namespace

double thin_to(std::vector<BodySurface>& surface, double tolerance, size_t most,
               const Progress& progress) {
  thin(surface, tolerance, progress);
  for (int trial = 1; trial < kTrials && triangle_count(surface) > most; ++trial) {
    const double done = tolerance;
    tolerance *= kGrowth;
    thin(surface, tolerance, progress, done);
  }
  return tolerance;
}

std::string words_of(const RobotLook& look, size_t drawn, double moved) {
  return "the robot has " + std::to_string(look.triangles) + " triangles, but it is drawn with " +
         std::to_string(drawn) + " triangles. This simplification moves the surface by about " +
         text::brief(1e3 * moved, 2) + " mm";
}

std::shared_ptr<const RobotLook> robot_look(const RobotModel& model, const Progress& progress) {
  auto look = std::make_shared<RobotLook>();
  look->surface = robot_surface(model);
  look->triangles = triangle_count(look->surface);
  look->ghost = ghost_colors(look->surface);
  if (look->triangles <= kMostTriangles) return look;
  const double height = robot_extent(look->surface, model, model.rest_state());
  leave_out_hidden(look->surface);
  look->moved = thin_to(look->surface, kThinned * height / kRows, kMostTriangles, progress);
  look->moved = std::max(look->moved, std::sqrt(3.0) * simplify(look->surface, kMostTriangles));
  return look;
}

}  // namespace ayumi
