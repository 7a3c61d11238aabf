// Pinocchio's forward dynamics of many states, as C++ users write it: a loop without allocation.

#include <pinocchio/algorithm/aba.hpp>

#include <cstddef>
#include <string>

using Rows = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>;

namespace {

pinocchio::JointModel about(int axis) {
  switch (axis) {
  case 0:
    return pinocchio::JointModelRX();
  case 1:
    return pinocchio::JointModelRY();
  default:
    return pinocchio::JointModelRZ();
  }
}

struct Arm {
  pinocchio::Model model;
  pinocchio::Data data;
};

} // namespace

extern "C" {

// Creates a chain of revolute joints. Each has an axis, the pose of its frame in the previous one (rotation in
// column-major order, position), and mass, centre of mass and inertia about it (xx, xy, yy, xz, yz, zz) of its body.
Arm *chain(std::size_t n, const int *axes, const double *poses, const double *inertias) {
  auto *arm = new Arm();
  for (std::size_t i = 0; i < n; ++i) {
    const double *pose = poses + 12 * i, *body = inertias + 10 * i;
    const pinocchio::SE3 at(Eigen::Map<const Eigen::Matrix3d>(pose), Eigen::Map<const Eigen::Vector3d>(pose + 9));
    const auto joint = arm->model.addJoint(i, about(axes[i]), at, "joint" + std::to_string(i));
    const pinocchio::Symmetric3 inertia(Eigen::Map<const Eigen::Matrix<double, 6, 1>>(body + 4));
    arm->model.appendBodyToJoint(joint, {body[0], Eigen::Map<const Eigen::Vector3d>(body + 1), inertia});
  }
  arm->data = pinocchio::Data(arm->model);
  return arm;
}

void accelerations(Arm *arm, bool world, std::size_t count, const double *q, const double *v, const double *tau,
                   double *out) {
  const auto convention = world ? pinocchio::Convention::WORLD : pinocchio::Convention::LOCAL;
  const int n = arm->model.nv;
  const Rows all_q(q, count, n), all_v(v, count, n), all_tau(tau, count, n);
  Eigen::VectorXd at(n), velocity(n), force(n);
  for (std::size_t k = 0; k < count; ++k) {
    at = all_q.row(k);
    velocity = all_v.row(k);
    force = all_tau.row(k);
    Eigen::Map<Eigen::VectorXd>(out + k * n, n) =
        pinocchio::aba(arm->model, arm->data, at, velocity, force, convention);
  }
}
}
