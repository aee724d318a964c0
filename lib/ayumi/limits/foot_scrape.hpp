#pragma once
// Corners of a swinging sole that slide along the ground, for the check and for the repair.

#include <Eigen/Geometry>
#include <functional>
#include <vector>

#include "ayumi/demand/contact_plan.hpp"
#include "ayumi/model/robot_model.hpp"

namespace ayumi {

/// A corner of a sole that slides along the ground in one sample.
struct Scrape {
  int corner = 0;     ///< index in Sole::polygon
  int place = 0;      ///< index of the contact interval whose plane is the ground below the corner
  double height = 0;  ///< height of the corner over this plane, negative below it [m]
};

/// The scraping corners of one foot, by sample. `pose_at` gives the pose of the sole in the world
/// in a sample of a swing. A corner is on the ground while it is lower than `low` [m], and it
/// scrapes where it is farther than `slip` [m] along the ground from the places in which it is at
/// rest.
std::vector<std::vector<Scrape>> scrapes(const Sole& sole, const ContactPlan& plan, Side side,
                                         const std::function<Eigen::Isometry3d(int)>& pose_at,
                                         double low, double slip);

}  // namespace ayumi
