// Times MuJoCo's step in C for two craft in contact, with all features disabled that the scene does not need.
// Usage: contact SCENE.xml START STEPS, where START holds the stiffness and damping of a pad, then qpos and qvel.
#include "contestant.hpp"
#include <memory>
#include <mujoco/mujoco.h>

// With the smallest impedance d, the force on a pad is k x + c v to 1e-4: MuJoCo solves
// (d A + (1 - d) D) f = s x + b v - d a0, where D is its estimate of A, and s and b are the numbers of solref.
constexpr double IMPEDANCE = 1e-4;

struct Scene {
  std::shared_ptr<mjModel> model;
  std::shared_ptr<mjData> data;
  int steps;

  Scene(const mjModel* from, int integrator, int parts, int steps)
      : model(mj_copyModel(nullptr, from), mj_deleteModel), data(mj_makeData(from), mj_deleteData), steps(steps * parts) {
    model->opt.integrator = integrator;
    model->opt.timestep /= parts;
  }

  void run(const Numbers& start) const {
    mj_resetData(model.get(), data.get());
    const double* row = start.data() + 2;
    std::copy(row, row + model->nq, data->qpos);
    std::copy(row + model->nq, row + model->nq + model->nv, data->qvel);
    for (int i = 0; i < steps; ++i) {
      mj_step(model.get(), data.get());
      if (data->ncon != 4)
        throw std::runtime_error("there are " + std::to_string(data->ncon) + " contacts; expected 4, one for each pad");
    }
  }

  // Appends qpos and qvel of one craft after the other.
  void ends(Numbers& out) const {
    const int nq = model->nq / 2, nv = model->nv / 2;
    for (int craft = 0; craft < 2; ++craft) {
      out.insert(out.end(), data->qpos + craft * nq, data->qpos + (craft + 1) * nq);
      out.insert(out.end(), data->qvel + craft * nv, data->qvel + (craft + 1) * nv);
    }
  }
};

int main(int, char** given) {
  char why[1000] = "";
  mjModel* model = mj_loadXML(given[1], nullptr, why, sizeof why);
  if (!model) throw std::runtime_error(why);
  const Numbers start = read_numbers(given[2]);
  const int steps = std::stoi(given[3]);
  model->opt.disableflags |= mjDSBL_EQUALITY | mjDSBL_LIMIT | mjDSBL_FRICTIONLOSS | mjDSBL_GRAVITY | mjDSBL_SPRING |
                             mjDSBL_DAMPER | mjDSBL_ACTUATION | mjDSBL_SENSOR | mjDSBL_EULERDAMP | mjDSBL_AUTORESET |
                             mjDSBL_ISLAND;
  for (int pair = 0; pair < model->npair; ++pair) {
    const int bodies[] = {model->geom_bodyid[model->pair_geom1[pair]], model->geom_bodyid[model->pair_geom2[pair]]};
    const double weight = model->body_invweight0[2 * bodies[0]] + model->body_invweight0[2 * bodies[1]];
    model->pair_solref[mjNREF * pair] = -start[0] * weight;
    model->pair_solref[mjNREF * pair + 1] = -start[1] * weight;
    model->pair_solimp[mjNIMP * pair] = model->pair_solimp[mjNIMP * pair + 1] = IMPEDANCE;
  }
  auto timed = [&](int integrator, int parts) {
    const Scene scene(model, integrator, parts, steps);
    auto result = [scene, &start](Numbers& out) { scene.run(start), scene.ends(out); };
    return job(scene.steps, [scene, &start] { scene.run(start), use(scene.data->qpos); }, result);
  };
  return serve({{"rk4", timed(mjINT_RK4, 1)}, {"implicitfast", timed(mjINT_IMPLICITFAST, 1)}, {"converged", timed(mjINT_RK4, 64)}});
}
