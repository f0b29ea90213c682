#include "core/physics/bullet_engine.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <btBulletCollisionCommon.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/isa.h"

namespace poise::physics {
namespace {

static_assert(sizeof(btScalar) == sizeof(double), "needs Bullet in double precision");

btVector3 ToBullet(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
btQuaternion ToBullet(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }
Vec3 FromBullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }
Quat FromBullet(const btQuaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

// Bullet's frame of a body lies at its centre of mass along its principal axes: the shape's.
Quat Principal(const Body& body) {
  return Quat(math::Mat3(Eigen::Map<const math::Mat3>(body.shape_axes)));
}
Vec3 Center(const Body& body) { return Vec3(Eigen::Map<const Vec3>(body.center_of_mass)); }
btVector3 PrincipalInertia(const Body& body) {
  const math::Mat3 axes = Eigen::Map<const math::Mat3>(body.shape_axes);
  const math::Mat3 inertia = Eigen::Map<const math::Mat3>(body.inertia);
  return ToBullet(Vec3((axes.transpose() * inertia * axes).diagonal()));
}

std::unique_ptr<btCollisionShape> MakeShape(const Body& body) {
  switch (body.geometry) {
    case Geometry::kCapsule:
      return std::make_unique<btCapsuleShape>(body.radius, 2 * body.half_length);
    case Geometry::kBox:
      return std::make_unique<btBoxShape>(
          btVector3(body.half_extents[0], body.half_extents[1], body.half_extents[2]));
    case Geometry::kSphere:
    case Geometry::kNone:
      break;
  }
  return std::make_unique<btSphereShape>(std::max(body.radius, 1e-6));
}

}  // namespace

struct BulletEngine::World {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  btDbvtBroadphase broadphase;
  btMultiBodyConstraintSolver solver;
  btMultiBodyDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  btStaticPlaneShape plane{btVector3(0, 1, 0), 0};
  btCollisionObject ground;
  std::vector<std::unique_ptr<btCollisionShape>> shapes;
  std::unique_ptr<btMultiBody> body;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders;
  // Scratch of Bullet's own functions.
  btAlignedObjectArray<btScalar> scalars;
  btAlignedObjectArray<btVector3> vectors;
  btAlignedObjectArray<btMatrix3x3> matrices;
  btAlignedObjectArray<btQuaternion> rotations;

  World(const Articulation& tree, const StepSettings& settings);
  ~World();
  void AddLinks(const Articulation& tree);
  void AddColliders(const Articulation& tree, const StepSettings& settings);
  void Place(const Articulation& tree, const StepState& state);
  void MoveColliders();
};

BulletEngine::World::World(const Articulation& tree, const StepSettings& settings) {
  world.setGravity(btVector3(settings.gravity[0], settings.gravity[1], settings.gravity[2]));
  btContactSolverInfo& info = world.getSolverInfo();
  info.m_numIterations = settings.solver_iterations;
  info.m_erp2 = settings.contact_erp;
  info.m_solverMode |= SOLVER_USE_2_FRICTION_DIRECTIONS;
  AddLinks(tree);
  AddColliders(tree, settings);
  world.addMultiBody(body.get());
}

BulletEngine::World::~World() {
  world.removeMultiBody(body.get());
  for (const auto& collider : colliders) world.removeCollisionObject(collider.get());
  if (ground.getBroadphaseHandle()) world.removeCollisionObject(&ground);
}

void BulletEngine::World::AddLinks(const Articulation& tree) {
  const Body& root = tree.bodies[0];
  body = std::make_unique<btMultiBody>(tree.num_bodies - 1, root.mass, PrincipalInertia(root),
                                       false, false);
  body->setLinearDamping(0);
  body->setAngularDamping(0);
  body->setMaxCoordinateVelocity(1e6);
  for (int i = 1; i < tree.num_bodies; ++i) {
    const Body& child = tree.bodies[i];
    const Body& parent = tree.bodies[child.parent];
    const Quat link = Principal(child), parent_link = Principal(parent);
    const btQuaternion turn = ToBullet(Quat(link.conjugate() * parent_link));
    const Vec3 offset = Eigen::Map<const Vec3>(child.offset);
    const btVector3 to_pivot = ToBullet(Vec3(parent_link.conjugate() * (offset - Center(parent))));
    const btVector3 to_center = ToBullet(Vec3(link.conjugate() * Center(child)));
    if (child.rigid_joint) {
      body->setupFixed(i - 1, child.mass, PrincipalInertia(child), child.parent - 1, turn, to_pivot,
                       to_center);
    } else {
      body->setupSpherical(i - 1, child.mass, PrincipalInertia(child), child.parent - 1, turn,
                           to_pivot, to_center, true);
    }
  }
  body->finalizeMultiDof();
}

void BulletEngine::World::AddColliders(const Articulation& tree, const StepSettings& settings) {
  const double friction = std::sqrt(settings.friction);
  body->setHasSelfCollision(settings.self_collision);
  for (int i = 0; i < tree.num_bodies; ++i) {
    shapes.push_back(MakeShape(tree.bodies[i]));
    colliders.push_back(std::make_unique<btMultiBodyLinkCollider>(body.get(), i - 1));
    btMultiBodyLinkCollider* collider = colliders.back().get();
    collider->setCollisionShape(shapes.back().get());
    collider->setFriction(friction);
    world.addCollisionObject(collider, btBroadphaseProxy::DefaultFilter,
                             btBroadphaseProxy::AllFilter);
    if (i == 0) {
      body->setBaseCollider(collider);
    } else {
      body->getLink(i - 1).m_collider = collider;
    }
  }
  if (!settings.ground) return;
  ground.setCollisionShape(&plane);
  ground.setFriction(friction);
  world.addCollisionObject(&ground, btBroadphaseProxy::StaticFilter,
                           btBroadphaseProxy::DefaultFilter);
}

void BulletEngine::World::Place(const Articulation& tree, const StepState& state) {
  using ConstQuat = Eigen::Map<const Quat>;
  const Quat root = ConstQuat(state.rotations);
  const Vec3 arm = root * Center(tree.bodies[0]);
  const Vec3 spin = Eigen::Map<const Vec3>(state.speeds + 3);
  body->setBasePos(ToBullet(Vec3(Eigen::Map<const Vec3>(state.root_position) + arm)));
  body->setWorldToBaseRot(ToBullet(Quat((root * Principal(tree.bodies[0])).conjugate())));
  body->setBaseOmega(ToBullet(spin));
  body->setBaseVel(ToBullet(Vec3(Eigen::Map<const Vec3>(state.speeds) + spin.cross(arm))));
  for (int i = 1; i < tree.num_bodies; ++i) {
    if (tree.bodies[i].rigid_joint) continue;
    const Quat link = Principal(tree.bodies[i]);
    const Quat turn = link.conjugate() * ConstQuat(state.rotations + 4 * i) * link;
    const Vec3 speed = link.conjugate() * Eigen::Map<const Vec3>(state.speeds + SpeedIndex(i));
    body->setJointPosMultiDof(i - 1, turn.coeffs().data());
    body->setJointVelMultiDof(i - 1, speed.data());
  }
  body->clearForcesAndTorques();
  MoveColliders();
}

void BulletEngine::World::MoveColliders() {
  body->forwardKinematics(rotations, vectors);
  body->updateCollisionObjectWorldTransforms(rotations, vectors);
}

BulletEngine::BulletEngine(const Articulation& tree, const StepSettings& settings)
    : tree_(tree), settings_(settings), world_(std::make_unique<World>(tree, settings)) {}

BulletEngine::~BulletEngine() = default;

void BulletEngine::Reset(const StepState& state) {
  world_->Place(tree_, state);
  // Warm starts and cached points of the motion before would push.
  for (int i = 0; i < world_->dispatcher.getNumManifolds(); ++i) {
    world_->dispatcher.getManifoldByIndexInternal(i)->clearManifold();
  }
  world_->solver.reset();
}

void BulletEngine::Step(const StepDrive& drive, StepState& state, StepEffort& effort) {
  static const auto control =
      base::SelectKernel(isa_v2::ControlKernel, isa_v3::ControlKernel, isa_v4::ControlKernel);
  double forces[kMaxSpeeds];
  control(tree_, settings_, drive, state, forces, effort);
  Advance(forces, state);
}

void BulletEngine::Advance(const double* forces, StepState& state) {
  for (int substep = 0; substep < settings_.substeps; ++substep) {
    AddForces(forces);
    // Without interpolation: a fixed step equal to the step can be skipped through rounding.
    world_->world.stepSimulation(settings_.step_s / settings_.substeps, 0);
  }
  ReadState(state);
  ReadContacts(state);
}

void BulletEngine::AddForces(const double* forces) {
  btMultiBody& body = *world_->body;
  const Vec3 force = Eigen::Map<const Vec3>(forces);
  const Quat root =
      FromBullet(body.getWorldToBaseRot().inverse()) * Principal(tree_.bodies[0]).conjugate();
  const Vec3 arm = root * Center(tree_.bodies[0]);
  body.addBaseForce(ToBullet(force));
  body.addBaseTorque(ToBullet(Vec3(Eigen::Map<const Vec3>(forces + 3) - arm.cross(force))));
  for (int i = 1; i < tree_.num_bodies; ++i) {
    if (tree_.bodies[i].rigid_joint) continue;
    const Vec3 torque =
        Principal(tree_.bodies[i]).conjugate() * Eigen::Map<const Vec3>(forces + SpeedIndex(i));
    body.addJointTorqueMultiDof(i - 1, torque.data());
  }
}

void BulletEngine::ReadState(StepState& state) const {
  const btMultiBody& body = *world_->body;
  const Body& base = tree_.bodies[0];
  const Quat root = FromBullet(body.getWorldToBaseRot().inverse()) * Principal(base).conjugate();
  const Vec3 arm = root * Center(base);
  const Vec3 spin = FromBullet(body.getBaseOmega());
  Eigen::Map<Quat>(state.rotations) = root.normalized();
  Eigen::Map<Vec3>(state.root_position) = FromBullet(body.getBasePos()) - arm;
  Eigen::Map<Vec3>(state.speeds) = FromBullet(body.getBaseVel()) - spin.cross(arm);
  Eigen::Map<Vec3>(state.speeds + 3) = spin;
  for (int i = 1; i < tree_.num_bodies; ++i) {
    if (tree_.bodies[i].rigid_joint) continue;
    const Quat link = Principal(tree_.bodies[i]);
    const Quat turn(Eigen::Map<const Quat>(body.getJointPosMultiDof(i - 1)));
    const Vec3 speed(Eigen::Map<const Vec3>(body.getJointVelMultiDof(i - 1)));
    Eigen::Map<Quat>(state.rotations + 4 * i) = (link * turn * link.conjugate()).normalized();
    Eigen::Map<Vec3>(state.speeds + SpeedIndex(i)) = link * speed;
  }
}

void BulletEngine::ReadContacts(StepState& state) const {
  state.num_contacts = 0;
  const auto index = [](const btCollisionObject* object) {
    const btMultiBodyLinkCollider* collider = btMultiBodyLinkCollider::upcast(object);
    return collider ? collider->m_link + 1 : -1;
  };
  for (int m = 0; m < world_->dispatcher.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *world_->dispatcher.getManifoldByIndexInternal(m);
    const int first = index(manifold.getBody0()), second = index(manifold.getBody1());
    const bool swap = first < second;  // the ground, or the earlier body, is the other
    for (int p = 0; p < manifold.getNumContacts() && state.num_contacts < kMaxContacts; ++p) {
      const btManifoldPoint& from = manifold.getContactPoint(p);
      ContactPoint& to = state.contacts[state.num_contacts++];
      to.body = swap ? second : first;
      to.other = swap ? first : second;
      to.feature = p;
      to.distance = from.getDistance();
      Eigen::Map<Vec3>(to.point) =
          FromBullet(swap ? from.getPositionWorldOnB() : from.getPositionWorldOnA());
      Eigen::Map<Vec3>(to.normal) = (swap ? -1 : 1) * FromBullet(from.m_normalWorldOnB);
      to.impulse[0] = from.m_appliedImpulse;
      to.impulse[1] = from.m_appliedImpulseLateral1;
      to.impulse[2] = from.m_appliedImpulseLateral2;
    }
  }
}

Speeds BulletEngine::FreeAcceleration(const State& state, const Speeds& forces) {
  StepState plain;
  std::copy_n(state.root_position.data(), 3, plain.root_position);
  std::copy_n(state.rotations[0].coeffs().data(), 4 * kMaxBodies, plain.rotations);
  std::copy_n(state.speeds.data(), kMaxSpeeds, plain.speeds);
  Reset(plain);
  btMultiBody& body = *world_->body;
  const btVector3 gravity = world_->world.getGravity();
  body.addBaseForce(gravity * body.getBaseMass());
  for (int i = 0; i < body.getNumLinks(); ++i) {
    body.addLinkForce(i, gravity * body.getLinkMass(i));
  }
  AddForces(forces.data());
  // A step of one second adds the acceleration to the velocity.
  world_->scalars.resize(body.getNumLinks() * 40 + 100);
  world_->vectors.resize(body.getNumLinks() * 40 + 100);
  world_->matrices.resize(body.getNumLinks() * 40 + 100);
  body.computeAccelerationsArticulatedBodyAlgorithmMultiDof(1, world_->scalars, world_->vectors,
                                                            world_->matrices, false, false, false);
  StepState after = plain;
  ReadState(after);
  Speeds change = Eigen::Map<const Speeds>(after.speeds) - state.speeds;
  // Bullet's base velocity is its centre's: the joint's acceleration misses the centripetal part.
  const Vec3 arm = state.rotations[0] * Center(tree_.bodies[0]);
  const Vec3 spin = state.speeds.segment<3>(3);
  change.head<3>() -= spin.cross(spin.cross(arm));
  Reset(plain);
  return change;
}

}  // namespace poise::physics
