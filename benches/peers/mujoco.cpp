// Times MuJoCo's Runge-Kutta step in C, with all features disabled that this robot does not need.
// Usage: mujoco MODEL.xml STATES RUNS STEPS. The runs start from the first RUNS states.
#include "contestant.hpp"
#include <mujoco/mujoco.h>

int main(int, char** given) {
  char why[1000] = "";
  mjModel* model = mj_loadXML(given[1], nullptr, why, sizeof why);
  if (!model) throw std::runtime_error(why);
  model->opt.integrator = mjINT_RK4;
  model->opt.disableflags |= mjDSBL_CONTACT | mjDSBL_CONSTRAINT | mjDSBL_EQUALITY | mjDSBL_LIMIT | mjDSBL_FRICTIONLOSS |
                             mjDSBL_GRAVITY | mjDSBL_SPRING | mjDSBL_DAMPER | mjDSBL_ACTUATION | mjDSBL_WARMSTART |
                             mjDSBL_SENSOR | mjDSBL_EULERDAMP | mjDSBL_AUTORESET | mjDSBL_ISLAND;
  mjData* data = mj_makeData(model);
  const Numbers states = read_numbers(given[2]);
  const size_t nq = static_cast<size_t>(model->nq), width = nq + static_cast<size_t>(model->nv);
  const size_t count = std::stoul(given[3]);
  const int steps = std::stoi(given[4]);
  auto run = [&](size_t k) {
    const double* row = states.data() + k * width;
    std::copy(row, row + nq, data->qpos);
    std::copy(row + nq, row + width, data->qvel);
    for (int i = 0; i < steps; ++i) mj_step(model, data);
  };
  size_t next = 0;
  auto ends = [&](Numbers& out) {
    for (size_t k = 0; k < count; ++k) {
      run(k);
      out.insert(out.end(), data->qpos, data->qpos + nq);
      out.insert(out.end(), data->qvel, data->qvel + model->nv);
    }
  };
  return serve({{"step", job(steps, [&] { run(next++ % count), use(data->qpos); }, ends)}});
}
