// The reduced model of an arm on a free base, `M* qdd + c* = tau` and `xdd = Jg qdd + d`, from Pinocchio's
// algorithms and Eigen's fixed-size matrices. N is the number of joints.
#pragma once
#include "robot.hpp"
#include <Eigen/Cholesky>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/rnea.hpp>

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

template <int N>
struct Reduced {
  using Square = Eigen::Matrix<double, N, N>;
  using Wide = Eigen::Matrix<double, 6, N>;
  using Vector = Eigen::Matrix<double, N, 1>;
  Square inertia;
  Vector bias;
  Wide jacobian;
  Vector6 drift, twist;
  Eigen::Matrix<double, 6, Eigen::Dynamic> J, dJ;

  explicit Reduced(long nv) : J(6, nv), dJ(6, nv) { J.setZero(), dJ.setZero(); }

  // Computes the model as in Pinocchio's documentation, with Jdot of all joints from its algorithm.
  void by_jacobian_rate(const Robot& robot, pinocchio::Data& data, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
    using namespace pinocchio;
    crba(robot.model, data, q, Convention::WORLD);
    nonLinearEffects(robot.model, data, q, v);
    computeJointJacobiansTimeVariation(robot.model, data, q, v);
    updateFramePlacement(robot.model, data, robot.tool);
    getFrameJacobian(robot.model, data, robot.tool, LOCAL_WORLD_ALIGNED, J);
    getFrameJacobianTimeVariation(robot.model, data, robot.tool, LOCAL_WORLD_ALIGNED, dJ);
    drift.noalias() = dJ * v;
    reduce(data, v);
  }

  // Computes the model with the fewest operations: CRBA in world axes computes placements and Jacobians, and the
  // accelerations of the bias forces yield the classical acceleration Jdot v of the tool.
  void by_acceleration(const Robot& robot, pinocchio::Data& data, const Eigen::VectorXd& q, const Eigen::VectorXd& v) {
    using namespace pinocchio;
    crba(robot.model, data, q, Convention::WORLD);
    nonLinearEffects(robot.model, data, q, v);
    updateFramePlacement(robot.model, data, robot.tool);
    getFrameJacobian(robot.model, data, robot.tool, LOCAL_WORLD_ALIGNED, J);
    const Frame& frame = robot.model.frames[robot.tool];
    const Motion velocity = frame.placement.actInv(data.v[frame.parentJoint]);
    const Motion acceleration = frame.placement.actInv(data.a_gf[frame.parentJoint]);
    const Eigen::Matrix3d& R = data.oMf[robot.tool].rotation();
    drift.head<3>() = R * (acceleration.linear() + velocity.angular().cross(velocity.linear()));
    drift.tail<3>() = R * acceleration.angular();
    reduce(data, v);
  }

 private:
  void reduce(const pinocchio::Data& data, const Eigen::VectorXd& v) {
    twist.noalias() = J * v;
    const Matrix6 Mbb = data.M.topLeftCorner<6, 6>().selfadjointView<Eigen::Upper>();
    const Wide Mbm = data.M.block<6, N>(0, 6);
    const Eigen::LLT<Matrix6> factor(Mbb);
    const Wide recoil = factor.solve(Mbm);
    const Vector6 push = factor.solve(Vector6(data.nle.head<6>()));
    inertia = data.M.block<N, N>(6, 6).template selfadjointView<Eigen::Upper>();
    inertia.noalias() -= Mbm.transpose() * recoil;
    bias = data.nle.segment<N>(6) - Mbm.transpose() * push;
    jacobian = J.rightCols<N>() - J.leftCols<6>() * recoil;
    drift -= J.leftCols<6>() * push;
  }
};
