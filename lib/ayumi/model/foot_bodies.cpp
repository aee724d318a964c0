#include "ayumi/model/foot_bodies.hpp"

namespace ayumi {

bool is_of_foot(const RobotModel& model, int body) {
  if (!model.has_soles()) return false;
  for (const Side side : {Side::left, Side::right})
    for (int i = body; i >= 0; i = model.bodies()[static_cast<size_t>(i)].parent)
      if (i == model.sole(side).body && (i == body || i > 0)) return true;
  return false;
}

}  // namespace ayumi
