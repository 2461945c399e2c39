// RBDL's part of generate_layouts.py: draws Q and QDot of a floating robot and prints what RBDL makes of them.
//
//   g++ -fpermissive -Iinclude -Iinclude/Linux -Iaddons/urdfreader -Iaddons/urdfreader/thirdparty -Iaddons -I.
//       -Ithird_party/eigen3/include generate_layouts_rbdl.cc src/*.cc addons/urdfreader/urdfreader.cc
//       addons/urdfreader/thirdparty/urdf/urdfdom/urdf_parser/src/{pose,model,link,joint}.cpp
//       addons/urdfreader/thirdparty/tinyxml/*.cpp addons/urdfreader/thirdparty/urdf/boost_replacement/*.cpp
//
// in the sources of PyPI's pyrbdl 0.0.2; then: a.out ROBOT.urdf LINK...

#include <cstdio>
#include <random>
#include <rbdl/rbdl.h>

#include "urdfreader.h"

using namespace RigidBodyDynamics;
using namespace RigidBodyDynamics::Math;

template <class Vector>
void print(const char* name, const Vector& values) {
  printf("\"%s\": [", name);
  for (int i = 0; i < values.size(); i++) printf("%s%.17g", i ? ", " : "", values[i]);
  printf("]");
}

int main(int count, char** words) {
  Model model;
  if (!Addons::URDFReadFromFile(words[1], &model, true, false)) return 1;
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> draw(-1.5, 1.5);
  VectorNd q(model.q_size), v(model.qdot_size);
  for (int i = 0; i < q.size(); i++) q[i] = draw(generator);
  for (int i = 0; i < v.size(); i++) v[i] = draw(generator);
  unsigned base = 0;
  for (unsigned i = 1; i < model.mJoints.size(); i++)
    if (model.mJoints[i].mJointType == JointTypeSpherical) base = i;
  Quaternion quat(draw(generator), draw(generator), draw(generator), draw(generator));
  quat.normalize();
  model.SetQuaternion(base, quat, q);
  UpdateKinematicsCustom(model, &q, &v, NULL);
  printf("{");
  print("q", q);
  printf(", ");
  print("v", v);
  printf(", \"links\": {");
  for (int k = 2; k < count; k++) {
    unsigned id = model.GetBodyId(words[k]);
    Vector3d p = CalcBodyToBaseCoordinates(model, q, id, Vector3d(0, 0, 0), false);
    Matrix3d e = CalcBodyWorldOrientation(model, q, id, false).transpose();
    SpatialVector twist = CalcPointVelocity6D(model, q, v, id, Vector3d(0, 0, 0), false);
    VectorNd rows(9), linear_first(6);
    for (int i = 0; i < 9; i++) rows[i] = e(i / 3, i % 3);
    for (int i = 0; i < 6; i++) linear_first[i] = twist[(i + 3) % 6];
    printf("%s\"%s\": {", k > 2 ? ", " : "", words[k]);
    print("position", p);
    printf(", ");
    print("rotation", rows);
    printf(", ");
    print("velocity", linear_first);
    printf("}");
  }
  printf("}, \"order\": {");
  bool is_first = true;
  for (int k = 2; k < count; k++) {
    unsigned id = model.GetBodyId(words[k]);
    if (id >= model.mJoints.size() || model.mJoints[id].mDoFCount != 1) continue;
    printf("%s\"%s\": %u", is_first ? "" : ", ", words[k], model.mJoints[id].q_index);
    is_first = false;
  }
  printf("}}\n");
}
