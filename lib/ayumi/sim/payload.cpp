#include "ayumi/sim/payload.hpp"

namespace ayumi {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

void add_point_mass(double mass, const Vector3d& point, LinkDescription& link) {
  Inertia& inertia = link.inertia;
  const Vector3d apart = point - inertia.com;
  const double total = inertia.mass + mass;
  if (!(total > 0)) return;
  const double reduced = inertia.mass * mass / total;
  inertia.about_com +=
      reduced * (apart.squaredNorm() * Matrix3d::Identity() - apart * apart.transpose());
  inertia.com += mass / total * apart;
  inertia.mass = total;
  link.has_inertial = true;
}

}  // namespace

RobotModel with_payloads(const RobotModel& model, const std::vector<CarriedMass>& payloads) {
  RobotDescription d = model.description();
  for (const CarriedMass& carried : payloads) {
    const std::string& name = model.links()[static_cast<size_t>(carried.link)].name;
    for (LinkDescription& link : d.links)
      if (link.name == name) add_point_mass(carried.mass, carried.point, link);
  }
  return RobotModel(d);
}

}  // namespace ayumi
