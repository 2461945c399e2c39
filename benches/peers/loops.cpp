// Times Pinocchio's forward dynamics of a robot whose two hands hold one load, instantiated here from its headers
// for this processor. The load is part of the first hand, and a weld connects it to the second hand.
// Usage: loops ROBOT STATES GRIPS, where GRIPS holds, for each hand, the index of the body, and the rotation (row by
// row) and position of the grip.
#include "robot.hpp"
#include <pinocchio/algorithm/constrained-dynamics.hpp>
#include <pinocchio/algorithm/loop-constrained-aba.hpp>

using namespace pinocchio;

// Reads the weld between both grips. Body k is moved by joint k + 1.
static RigidConstraintModel read_weld(const Model& model, const std::string& file) {
  std::ifstream in(file);
  JointIndex joints[2];
  SE3 grips[2];
  for (int side = 0; side < 2; ++side) {
    in >> joints[side];
    joints[side] += 1;
    Eigen::Matrix3d rotation;
    Eigen::Vector3d position;
    for (int i = 0; i < 9; ++i) in >> rotation(i / 3, i % 3);
    for (int i = 0; i < 3; ++i) in >> position[i];
    grips[side] = SE3(rotation, position);
  }
  if (!in) throw std::runtime_error("the file " + file + " does not hold two complete grips");
  return RigidConstraintModel(CONTACT_6D, model, joints[0], grips[0], joints[1], grips[1], LOCAL);
}

int main(int, char** given) {
  const Robot robot(given[1]);
  const Model& model = robot.model;
  const std::vector<State> states = read_states(model, given[2]);
  PINOCCHIO_STD_VECTOR_WITH_EIGEN_ALLOCATOR(RigidConstraintModel) welds{read_weld(model, given[3])};
  PINOCCHIO_STD_VECTOR_WITH_EIGEN_ALLOCATOR(RigidConstraintData) found{welds[0].createData()};
  Data data(model), recursive(model);
  initConstraintDynamics(model, data, welds, found);
  computeJointMinimalOrdering(model, recursive, welds);

  auto each = [&](auto run) {
    auto pass = [&states, run] { for (const State& s : states) use(run(s)); };
    auto all = [&states, &model, run](Numbers& out) {
      for (const State& s : states) append_rows(out, Eigen::Map<const Eigen::VectorXd>(run(s), model.nv));
    };
    return job(static_cast<double>(states.size()), pass, all);
  };
  // no row is redundant: without the proximal term, one solution is exact
  auto direct = [&](const State& s) {
    ProximalSettings settings(1e-12, 0.0, 1);
    return constraintDynamics(model, data, s.q, s.v, s.x, welds, found, settings).data();
  };
  auto proximal = [&](const State& s) {
    ProximalSettings settings(1e-14, 1e-4, 100);
    return constraintDynamics(model, data, s.q, s.v, s.x, welds, found, settings).data();
  };
  auto loop_aba = [&](const State& s) {
    ProximalSettings settings(1e-14, 1e-4, 100);
    return lcaba(model, recursive, s.q, s.v, s.x, welds, found, settings).data();
  };
  return serve({{"constrained", each(direct)}, {"constrained_proximal", each(proximal)}, {"lcaba", each(loop_aba)}});
}
