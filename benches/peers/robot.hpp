// Pinocchio's model and states, read from the tables that benches/versus/robots.py writes.
#pragma once
#include "contestant.hpp"
#include <pinocchio/multibody.hpp>
#include <pinocchio/spatial.hpp>

// Reads a body of the table: mass, centre of mass, and inertia about it (xx xy xz yy yz zz).
inline pinocchio::Inertia read_body(std::istream& in) {
  double mass, xx, xy, xz, yy, yz, zz;
  Eigen::Vector3d com;
  in >> mass >> com[0] >> com[1] >> com[2] >> xx >> xy >> xz >> yy >> yz >> zz;
  Eigen::Matrix3d inertia;
  inertia << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return {mass, com, inertia};
}

inline pinocchio::SE3 read_offset(std::istream& in) {
  Eigen::Vector3d p;
  in >> p[0] >> p[1] >> p[2];
  return {Eigen::Matrix3d::Identity(), p};
}

struct Robot {
  pinocchio::Model model;
  pinocchio::FrameIndex tool = 0;

  // all joints rotate about x, y or z, for which Pinocchio has its fastest joint types
  explicit Robot(const std::string& file) {
    using namespace pinocchio;
    std::ifstream in(file);
    int joints;
    in >> joints;
    std::vector<JointIndex> at{model.addJoint(0, JointModelFreeFlyer(), SE3::Identity(), "base")};
    model.appendBodyToJoint(at[0], read_body(in), SE3::Identity());
    for (int k = 1; k <= joints; ++k) {
      int parent;
      char axis;
      in >> parent >> axis;
      const SE3 placement = read_offset(in);
      const std::string name = "joint" + std::to_string(k);
      at.push_back(axis == 'x'   ? model.addJoint(at[parent], JointModelRX(), placement, name)
                   : axis == 'y' ? model.addJoint(at[parent], JointModelRY(), placement, name)
                                 : model.addJoint(at[parent], JointModelRZ(), placement, name));
      model.appendBodyToJoint(at[k], read_body(in), SE3::Identity());
    }
    int carrier;
    in >> carrier;
    tool = model.addFrame(Frame("tool", at[carrier], read_offset(in), OP_FRAME));
    if (!in) throw std::runtime_error("the file " + file + " does not hold a complete robot");
    model.gravity.setZero();
  }
};

// Configuration, velocity, and torques or accelerations.
struct State {
  Eigen::VectorXd q, v, x;
};

inline std::vector<State> read_states(const pinocchio::Model& model, const std::string& file) {
  const Numbers all = read_numbers(file);
  const long nq = model.nq, nv = model.nv, width = nq + 2 * nv;
  std::vector<State> states;
  for (const double* row = all.data(); row < all.data() + all.size(); row += width)
    states.push_back({Eigen::Map<const Eigen::VectorXd>(row, nq), Eigen::Map<const Eigen::VectorXd>(row + nq, nv),
                      Eigen::Map<const Eigen::VectorXd>(row + nq + nv, nv)});
  return states;
}

template <class Matrix>
void append_rows(Numbers& out, const Matrix& a) {
  for (long i = 0; i < a.rows(); ++i)
    for (long j = 0; j < a.cols(); ++j) out.push_back(a(i, j));
}
