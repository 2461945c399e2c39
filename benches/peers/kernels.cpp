// Times Pinocchio's kernels for one state, instantiated here from its headers for this processor.
// Usage: kernels ROBOT STATES.
#include "reduced.hpp"
#include <pinocchio/algorithm/aba-derivatives.hpp>
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/kinematics.hpp>

using namespace pinocchio;

template <int N>
int contest(const Robot& robot, const std::string& file) {
  const Model& model = robot.model;
  const std::vector<State> states = read_states(model, file);
  Data data(model);
  Reduced<N> reduced(model.nv);
  auto &J = reduced.J, &dJ = reduced.dJ;
  Vector6 drift;

  // a job that calls `run` for every state and appends the `result` of each
  auto each = [&](auto run, auto result) {
    auto pass = [&states, run] { for (const State& s : states) run(s); };
    auto all = [&states, run, result](Numbers& out) { for (const State& s : states) run(s), result(out); };
    return job(static_cast<double>(states.size()), pass, all);
  };
  auto mass = [&](Numbers& out) { append_rows(out, Eigen::MatrixXd(data.M.selfadjointView<Eigen::Upper>())); };
  auto acceleration = [&](Numbers& out) { append_rows(out, data.ddq); };
  auto task = [&](Numbers& out) { append_rows(out, J), append_rows(out, drift); };
  auto all_of_it = [&](Numbers& out) {
    append_rows(out, reduced.inertia), append_rows(out, reduced.bias);
    append_rows(out, reduced.jacobian), append_rows(out, reduced.drift);
  };
  auto mirrored = [&](Numbers& out) {
    append_rows(out, data.ddq_dq), append_rows(out, data.ddq_dv);
    append_rows(out, Eigen::MatrixXd(data.Minv.selfadjointView<Eigen::Upper>()));
  };

  auto aba_in = [&](Convention axes) {
    return each([&, axes](const State& s) { aba(model, data, s.q, s.v, s.x, axes), use(data.ddq.data()); }, acceleration);
  };
  auto crba_in = [&](Convention axes) {
    return each([&, axes](const State& s) { crba(model, data, s.q, axes), use(data.M.data()); }, mass);
  };
  return serve({
      {"aba", aba_in(Convention::WORLD)},
      {"aba_local", aba_in(Convention::LOCAL)},
      {"crba", crba_in(Convention::LOCAL)},
      {"crba_world", crba_in(Convention::WORLD)},
      {"rnea", each([&](const State& s) { rnea(model, data, s.q, s.v, s.x), use(data.tau.data()); },
                    [&](Numbers& out) { append_rows(out, data.tau); })},
      {"jacobian", each(
           [&](const State& s) {
             forwardKinematics(model, data, s.q, s.v, Eigen::VectorXd::Zero(model.nv));
             computeJointJacobians(model, data);
             updateFramePlacement(model, data, robot.tool);
             getFrameJacobian(model, data, robot.tool, LOCAL_WORLD_ALIGNED, J);
             drift = getFrameClassicalAcceleration(model, data, robot.tool, LOCAL_WORLD_ALIGNED).toVector();
             use(J.data()), use(drift.data());
           },
           task)},
      {"jacobian_rate", each(
           [&](const State& s) {
             computeJointJacobiansTimeVariation(model, data, s.q, s.v);
             updateFramePlacement(model, data, robot.tool);
             getFrameJacobian(model, data, robot.tool, LOCAL_WORLD_ALIGNED, J);
             getFrameJacobianTimeVariation(model, data, robot.tool, LOCAL_WORLD_ALIGNED, dJ);
             drift.noalias() = dJ * s.v;
             use(J.data()), use(drift.data());
           },
           task)},
      {"reduced", each([&](const State& s) { reduced.by_acceleration(robot, data, s.q, s.v), use(&reduced); }, all_of_it)},
      {"reduced_rate",
       each([&](const State& s) { reduced.by_jacobian_rate(robot, data, s.q, s.v), use(&reduced); }, all_of_it)},
      {"derivatives", each(
           [&](const State& s) { computeABADerivatives(model, data, s.q, s.v, s.x), use(data.ddq_dq.data()); }, mirrored)},
  });
}

int main(int, char** given) {
  const Robot robot(given[1]);
  return robot.model.nv == 13 ? contest<7>(robot, given[2]) : contest<14>(robot, given[2]);
}
