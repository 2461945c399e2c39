// Times an arm under computed torque in optimised C++ with Pinocchio and Eigen. The control law is evaluated once
// per step, and its torque is held during a step of fourth-order Runge-Kutta. There is no orbit, no external wrench
// and no recording. Usage: controlled ROBOT STATES TASK.
#include "reduced.hpp"
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/joint-configuration.hpp>

using namespace pinocchio;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Gains, steps and the path p(t) = start + s d + s (1 - s) h, where s is the quintic from 0 to 1 over the duration.
struct Task {
  double kp, kd, self_motion, time_step, duration;
  int steps;
  SE3 start;
  Vector3d displacement, height;

  explicit Task(const std::string& file) {
    std::ifstream in(file);
    Eigen::Matrix3d rotation;
    in >> kp >> kd >> self_motion >> time_step >> steps >> duration;
    for (int i = 0; i < 9; ++i) in >> rotation(i / 3, i % 3);
    start.rotation(rotation);
    for (Vector3d* x : {&start.translation(), &displacement, &height}) in >> (*x)[0] >> (*x)[1] >> (*x)[2];
    if (!in) throw std::runtime_error("the file " + file + " does not hold a complete task");
  }

  void at(double t, Vector3d& p, Vector3d& velocity, Vector3d& acceleration) const {
    const double u = std::min(t / duration, 1.0), w = 1 - u, per_s = 1 / duration;
    const double s = u * u * u * (10 + u * (6 * u - 15));
    const double rate = 30 * u * u * w * w * per_s, second = 60 * u * w * (w - u) * per_s * per_s;
    const Vector3d slope = displacement + height * (1 - 2 * s);
    p = start.translation() + displacement * s + height * (s * (1 - s));
    velocity = slope * rate;
    acceleration = slope * second - height * (2 * rate * rate);
  }
};

template <int N>
struct Arm {
  const Robot& robot;
  const Task& task;
  Data data;
  Reduced<N> reduced;
  VectorXd q, v, tau, turned, k1, k2, k3, k4, v2, v3, v4, moved;

  Arm(const Robot& robot, const Task& task) : robot(robot), task(task), data(robot.model), reduced(robot.model.nv) {
    const long nv = robot.model.nv;
    turned = VectorXd::Zero(robot.model.nq);
    for (VectorXd* x : {&tau, &k1, &k2, &k3, &k4, &v2, &v3, &v4, &moved}) *x = VectorXd::Zero(nv);
  }

  void law(double t, bool by_rate) {
    by_rate ? reduced.by_jacobian_rate(robot, data, q, v) : reduced.by_acceleration(robot, data, q, v);
    const auto& Jg = reduced.jacobian;
    Vector3d p, velocity, acceleration;
    task.at(t, p, velocity, acceleration);
    const SE3& pose = data.oMf[robot.tool];
    Vector6 error, command;
    error << p - pose.translation(), log3(Eigen::Matrix3d(task.start.rotation() * pose.rotation().transpose()));
    command = task.kp * error - task.kd * reduced.twist - reduced.drift;
    command.head<3>() += acceleration + task.kd * velocity;
    // qdd = J+ (command + k J qd) - k qd: self-motion damped in the null space
    const auto rates = v.segment<N>(6);
    command += task.self_motion * (Jg * rates);
    const Matrix6 gram = Jg * Jg.transpose();
    const Eigen::Matrix<double, N, 1> wanted = Jg.transpose() * gram.llt().solve(command) - task.self_motion * rates;
    tau.segment<N>(6) = reduced.inertia * wanted + reduced.bias;
  }

  void step() {
    const double h = task.time_step;
    const Model& model = robot.model;
    k1 = aba(model, data, q, v, tau, Convention::WORLD);
    v2 = v + h / 2 * k1, moved = h / 2 * v, integrate(model, q, moved, turned);
    k2 = aba(model, data, turned, v2, tau, Convention::WORLD);
    v3 = v + h / 2 * k2, moved = h / 2 * v2, integrate(model, q, moved, turned);
    k3 = aba(model, data, turned, v3, tau, Convention::WORLD);
    v4 = v + h * k3, moved = h * v3, integrate(model, q, moved, turned);
    k4 = aba(model, data, turned, v4, tau, Convention::WORLD);
    moved = h / 6 * (v + 2 * v2 + 2 * v3 + v4), integrate(model, q, moved, turned);
    q = turned;
    v += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }

  void run(const State& from, bool by_rate) {
    q = from.q, v = from.v;
    for (int k = 0; k < task.steps; ++k) law(k * task.time_step, by_rate), step();
  }
};

template <int N>
int contest(const Robot& robot, const std::string& file, const Task& task) {
  const std::vector<State> states = read_states(robot.model, file);
  Arm<N> arm(robot, task);
  size_t next = 0;
  auto with = [&](bool by_rate) {
    auto pass = [&, by_rate] { arm.run(states[next++ % states.size()], by_rate), use(arm.q.data()); };
    auto ends = [&, by_rate](Numbers& out) {
      for (const State& s : states) arm.run(s, by_rate), append_rows(out, arm.q), append_rows(out, arm.v);
    };
    return job(task.steps, pass, ends);
  };
  return serve({{"step", with(false)}, {"step_rate", with(true)}});
}

int main(int, char** given) {
  const Robot robot(given[1]);
  const Task task(given[3]);
  return robot.model.nv == 13 ? contest<7>(robot, given[2], task) : contest<14>(robot, given[2], task);
}
