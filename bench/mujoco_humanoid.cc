#include "bench/mujoco_humanoid.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace poise::bench {
namespace {

using physics::Articulation;
using physics::Body;
using physics::Geometry;
using physics::Quat;
using physics::Vec3;

std::string Numbers(const double* values) {
  return fmt::format("{} {} {}", values[0], values[1], values[2]);
}

std::string GeomXml(const Body& body, bool self_collision) {
  const Quat turn(math::Mat3(Eigen::Map<const math::Mat3>(body.shape_axes)));
  std::string shape;
  if (body.geometry == Geometry::kSphere) {
    shape = fmt::format("type='sphere' size='{}'", body.radius);
  } else if (body.geometry == Geometry::kCapsule) {
    shape = fmt::format("type='capsule' size='{} {}'", body.radius, body.half_length);
  } else {
    shape = fmt::format("type='box' size='{}'", Numbers(body.half_extents));
  }
  // A capsule lies along MuJoCo's z, ours along y.
  const Quat quarter = body.geometry == Geometry::kCapsule
                           ? Quat(Eigen::AngleAxisd(-M_PI / 2, Vec3::UnitX()))
                           : Quat::Identity();
  const Quat q = turn * quarter;
  return fmt::format("<geom {} pos='{}' quat='{} {} {} {}' contype='1' conaffinity='{}'/>", shape,
                     Numbers(body.shape_center), q.w(), q.x(), q.y(), q.z(),
                     self_collision ? 1 : 0);
}

std::string BodyXml(const Articulation& tree, int i, bool self_collision) {
  const Body& body = tree.bodies[i];
  const math::Mat3 inertia = Eigen::Map<const math::Mat3>(body.inertia);
  std::string xml = fmt::format("<body name='b{}' pos='{}'>", i, Numbers(body.offset));
  xml += fmt::format("<inertial pos='{}' mass='{}' fullinertia='{} {} {} {} {} {}'/>",
                     Numbers(body.center_of_mass), body.mass, inertia(0, 0), inertia(1, 1),
                     inertia(2, 2), inertia(0, 1), inertia(0, 2), inertia(1, 2));
  if (i == 0) {
    xml += "<freejoint/>";
  } else if (!body.rigid_joint) {
    xml += fmt::format("<joint type='ball' stiffness='{}' damping='{}'/>", body.stiffness,
                       body.damping);
  }
  xml += GeomXml(body, self_collision);
  for (int child = i + 1; child < tree.num_bodies; ++child) {
    if (tree.bodies[child].parent == i) xml += BodyXml(tree, child, self_collision);
  }
  return xml + "</body>";
}

mjModel* Load(const Articulation& tree, const MujocoHumanoid::Options& options) {
  std::string xml = fmt::format(
      "<mujoco><option timestep='{}' gravity='0 -9.8 0' solver='{}' iterations='{}'/>"
      "<default><geom friction='0.81 0.005 0.0001' condim='3'/></default><worldbody>"
      "<geom type='plane' size='0 0 1' zaxis='0 1 0'/>",
      1 / options.rate_hz, options.solver, options.solver == "PGS" ? 20 : 100);
  xml += BodyXml(tree, 0, options.self_collision) + "</worldbody></mujoco>";
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "humanoid.xml", static_cast<int>(xml.size()));
  std::memcpy(files->filedata[mj_findFileVFS(files.get(), "humanoid.xml")], xml.data(), xml.size());
  char error[500] = "";
  mjModel* model = mj_loadXML("humanoid.xml", files.get(), error, sizeof(error));
  mj_deleteVFS(files.get());
  if (model == nullptr) {
    fmt::print(stderr, "MuJoCo refuses the humanoid: {}\n", error);
    std::abort();
  }
  return model;
}

void CopyQuat(const Quat& from, mjtNum* to) {
  to[0] = from.w();
  to[1] = from.x();
  to[2] = from.y();
  to[3] = from.z();
}

}  // namespace

struct MujocoHumanoid::Simulation {
  mjModel* model;
  mjData* data;
  std::vector<int> address;  // of each body's joint in qpos; -1 = rigid

  explicit Simulation(mjModel* loaded) : model(loaded), data(mj_makeData(loaded)) {}
  ~Simulation() {
    mj_deleteData(data);
    mj_deleteModel(model);
  }
};

MujocoHumanoid::MujocoHumanoid(const Articulation& tree, const Options& options)
    : simulation_(std::make_unique<Simulation>(Load(tree, options))), num_bodies_(tree.num_bodies) {
  const mjModel& model = *simulation_->model;
  for (int i = 0; i < num_bodies_; ++i) {
    const int body = mj_name2id(&model, mjOBJ_BODY, fmt::format("b{}", i).c_str());
    const int joint = model.body_jntadr[body];
    simulation_->address.push_back(joint < 0 ? -1 : model.jnt_qposadr[joint]);
  }
}

MujocoHumanoid::~MujocoHumanoid() = default;

void MujocoHumanoid::Reset(const physics::State& state) {
  mj_resetData(simulation_->model, simulation_->data);
  mjtNum* positions = simulation_->data->qpos;
  for (int k = 0; k < 3; ++k) positions[k] = state.root_position[k];
  CopyQuat(state.rotations[0], positions + 3);
  for (int i = 1; i < num_bodies_; ++i) {
    if (simulation_->address[i] >= 0) {
      CopyQuat(state.rotations[i], positions + simulation_->address[i]);
    }
  }
}

void MujocoHumanoid::Advance(const physics::Drive& drive, int steps) {
  mjModel& model = *simulation_->model;
  mjData& data = *simulation_->data;
  for (int i = 1; i < num_bodies_; ++i) {
    if (simulation_->address[i] >= 0) {
      CopyQuat(drive.target_rotations[i], model.qpos_spring + simulation_->address[i]);
    }
  }
  for (int step = 0; step < steps; ++step) {
    const Vec3 position = Eigen::Map<const Vec3>(data.qpos);
    const Vec3 velocity = Eigen::Map<const Vec3>(data.qvel);
    const Vec3 force = drive.residual.stiffness * (drive.target_root - position) -
                       drive.residual.damping * velocity;
    for (int k = 0; k < 3; ++k) data.xfrc_applied[6 + k] = force[k];
    mj_step(&model, &data);
  }
}

bool MujocoHumanoid::Finite() const { return std::isfinite(simulation_->data->qpos[1]); }

}  // namespace poise::bench
