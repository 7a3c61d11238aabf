// Reads URDF files with the library from Pinocchio's wheel.

#include "robot.h"

#include <pinocchio/algorithm/joint-configuration.hpp>
#include <pinocchio/algorithm/model.hpp>
#include <pinocchio/parsers/urdf.hpp>

#include <algorithm>
#include <exception>
#include <iostream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

Kind kind(const pinocchio::JointModel &joint) {
  const std::string name = joint.shortname();
  const char *names[] = {"JointModelFreeFlyer", "JointModelRX", "JointModelRY", "JointModelRZ"};
  const auto found = std::find(std::begin(names), std::end(names), name);
  if (found == std::end(names))
    throw std::invalid_argument(name + " is not supported");
  return static_cast<Kind>(found - std::begin(names));
}

Placed placed(pinocchio::JointIndex parent, const pinocchio::SE3 &at) {
  Placed out{static_cast<int>(parent), {}, {}};
  Eigen::Map<Eigen::Matrix3d>(out.rotation) = at.rotation();
  Eigen::Map<Eigen::Vector3d>(out.position) = at.translation();
  return out;
}

} // namespace

extern "C" {

// Reads a robot with a fixed or a floating base, and the frame of a link. `locked` is a null-terminated list of joints
// fixed at 0. On failure, prints the reason and returns a null pointer.
Description *pin_read(const char *urdf, int floating, const char *const *locked, const char *link) try {
  pinocchio::Model model;
  if (floating)
    pinocchio::urdf::buildModel(urdf, pinocchio::JointModelFreeFlyer(), model);
  else
    pinocchio::urdf::buildModel(urdf, model);
  std::vector<pinocchio::JointIndex> ids;
  for (; *locked; ++locked)
    ids.push_back(model.getJointId(*locked));
  if (!ids.empty())
    model = pinocchio::buildReducedModel(model, ids, pinocchio::neutral(model));
  if (!model.existFrame(link, pinocchio::BODY))
    throw std::invalid_argument(std::string("there is no link ") + link);
  auto out = std::make_unique<Description>();
  out->count = model.njoints - 1;
  if (out->count > static_cast<int>(std::size(out->joints)))
    throw std::invalid_argument("too many joints");
  for (int i = 1; i < model.njoints; ++i) {
    Joint &joint = out->joints[i - 1];
    const pinocchio::Inertia &body = model.inertias[i];
    joint.kind = kind(model.joints[i]);
    joint.at = placed(model.parents[i], model.jointPlacements[i]);
    joint.mass = body.mass();
    Eigen::Map<Eigen::Vector3d>(joint.com) = body.lever();
    Eigen::Map<Eigen::Matrix<double, 6, 1>>(joint.inertia) = body.inertia().data();
  }
  const pinocchio::Frame &frame = model.frames[model.getFrameId(link, pinocchio::BODY)];
  out->link = placed(frame.parentJoint, frame.placement);
  return out.release();
} catch (const std::exception &why) {
  std::cerr << why.what() << '\n';
  return nullptr;
}

void pin_forget(Description *description) { delete description; }
}
