// C interface to Pinocchio's algorithms: a robot, states added in advance, and one function for each algorithm, which
// returns a pointer to its result.
//
// Timed calls neither copy nor allocate: states are Eigen vectors, and results stay in Pinocchio's `Data`.

#include "robot.h"

#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/regressor.hpp>
#include <pinocchio/algorithm/rnea.hpp>

#include <cstddef>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

namespace {

struct State {
  Eigen::VectorXd q, v, a, tau;
};

pinocchio::SE3 place(const Placed &at) {
  return {Eigen::Map<const Eigen::Matrix3d>(at.rotation), Eigen::Map<const Eigen::Vector3d>(at.position)};
}

pinocchio::JointModel joint(Kind kind) {
  switch (kind) {
  case ABOUT_X:
    return pinocchio::JointModelRX();
  case ABOUT_Y:
    return pinocchio::JointModelRY();
  case ABOUT_Z:
    return pinocchio::JointModelRZ();
  default:
    return pinocchio::JointModelFreeFlyer();
  }
}

pinocchio::Model built(const Description &description) {
  pinocchio::Model model;
  for (int i = 0; i < description.count; ++i) {
    const Joint &from = description.joints[i];
    const auto id = model.addJoint(from.at.parent, joint(from.kind), place(from.at), "joint" + std::to_string(i));
    const pinocchio::Symmetric3 inertia(Eigen::Map<const Eigen::Matrix<double, 6, 1>>(from.inertia));
    model.appendBodyToJoint(id, {from.mass, Eigen::Map<const Eigen::Vector3d>(from.com), inertia});
  }
  const Placed &link = description.link;
  model.addFrame(pinocchio::Frame("link", link.parent, 0, place(link), pinocchio::BODY));
  return model;
}

struct Robot {
  pinocchio::Model model;
  pinocchio::Data data;
  pinocchio::FrameIndex frame;
  pinocchio::Data::Matrix6x jacobian;
  std::vector<State> states;

  explicit Robot(const Description &description)
      : model(built(description)), data(model), frame(model.frames.size() - 1),
        jacobian(pinocchio::Data::Matrix6x::Zero(6, model.nv)) {}
};

Eigen::VectorXd vector(const double *numbers, int count) {
  return Eigen::Map<const Eigen::VectorXd>(numbers, count);
}

} // namespace

extern "C" {

// Creates a robot; on failure, prints the reason and returns a null pointer.
Robot *pin_open(const Description *description) try {
  return new Robot(*description);
} catch (const std::exception &why) {
  std::cerr << why.what() << '\n';
  return nullptr;
}

void pin_close(Robot *robot) { delete robot; }

int pin_nq(const Robot *robot) { return robot->model.nq; }

int pin_nv(const Robot *robot) { return robot->model.nv; }

// Number of bodies, each with ten parameters.
int pin_bodies(const Robot *robot) { return robot->model.njoints - 1; }

// Adds a state, to which later calls refer by its index.
void pin_add(Robot *robot, const double *q, const double *v, const double *a, const double *tau) {
  const int nq = robot->model.nq, nv = robot->model.nv;
  robot->states.push_back({vector(q, nq), vector(v, nv), vector(a, nv), vector(tau, nv)});
}

// Inverse dynamics: tau.
const double *pin_rnea(Robot *robot, std::size_t k) {
  const State &at = robot->states[k];
  return pinocchio::rnea(robot->model, robot->data, at.q, at.v, at.a).data();
}

// Forward dynamics with local frames: the acceleration.
const double *pin_aba_local(Robot *robot, std::size_t k) {
  const State &at = robot->states[k];
  return pinocchio::aba(robot->model, robot->data, at.q, at.v, at.tau, pinocchio::Convention::LOCAL).data();
}

// Forward dynamics with the world frame: the acceleration.
const double *pin_aba_world(Robot *robot, std::size_t k) {
  const State &at = robot->states[k];
  return pinocchio::aba(robot->model, robot->data, at.q, at.v, at.tau, pinocchio::Convention::WORLD).data();
}

// Derivatives of the acceleration by displacements, in row-major order; `pin_by_velocity` returns those by velocities.
const double *pin_derivatives(Robot *robot, std::size_t k) {
  const State &at = robot->states[k];
  pinocchio::computeABADerivatives(robot->model, robot->data, at.q, at.v, at.tau);
  return robot->data.ddq_dq.data();
}

// Derivatives of the acceleration by velocities from the last call of `pin_derivatives`, in row-major order.
const double *pin_by_velocity(const Robot *robot) { return robot->data.ddq_dv.data(); }

// Derivatives of the acceleration by forces from the last call of `pin_derivatives`, a symmetric matrix.
const double *pin_by_force(const Robot *robot) { return robot->data.Minv.data(); }

// Regressor with ten columns for each body, in column-major order.
const double *pin_regressor(Robot *robot, std::size_t k) {
  const State &at = robot->states[k];
  return pinocchio::computeJointTorqueRegressor(robot->model, robot->data, at.q, at.v, at.a).data();
}

// Frame Jacobian: six rows, linear before angular, in world axes, column-major. Columns of joints that do not move the
// frame stay 0.
const double *pin_jacobian(Robot *robot, std::size_t k) {
  const State &at = robot->states[k];
  pinocchio::computeFrameJacobian(robot->model, robot->data, at.q, robot->frame, pinocchio::LOCAL_WORLD_ALIGNED,
                                  robot->jacobian);
  return robot->jacobian.data();
}

// Inertial parameters, in the order of the columns of the regressor.
void pin_parameters(const Robot *robot, double *out) {
  for (int i = 1; i < robot->model.njoints; ++i)
    Eigen::Map<Eigen::Matrix<double, 10, 1>>(out + 10 * (i - 1)) = robot->model.inertias[i].toDynamicParameters();
}
}
