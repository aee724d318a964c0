#include "ayumi/dynamics/robot_data.hpp"

#include "ayumi/dynamics/tree_cholesky.hpp"
#include "ayumi/dynamics/tree_links.hpp"
#include "ayumi/model/gravity.hpp"

namespace ayumi {

RobotData::RobotData(const RobotModel& model, const kernels::Kernels& which)
    : links(tree_links(model)), kernels(&which) {
  const size_t n = model.bodies().size();
  rotation.resize(n);
  for (auto* field : {&position, &axis, &com, &angular_velocity, &velocity}) field->resize(n);
  composite.resize(n);
  for (const kernels::Link& link : links) subtree_mass.push_back(link.subtree_mass);
  const TreeCholesky order(model);
  for (int c = 0; c < model.velocity_count(); ++c) {
    column_begin.push_back(c * model.velocity_count());
    column.push_back(c);
    rank.push_back(order.place_of(c));
  }
  scratch.resize(static_cast<size_t>(kernels::body_scratch_doubles(static_cast<int>(n)) / 8 + 1));
}

kernels::Tree RobotData::tree() const {
  return {links.data(), static_cast<int>(links.size()), static_cast<int>(column.size()) - 6,
          kGravity};
}

kernels::Bodies RobotData::bodies() {
  return {rotation[0].data(),         position[0].data(), axis[0].data(),   com[0].data(),
          angular_velocity[0].data(), velocity[0].data(), scratch[0].number};
}

}  // namespace ayumi
