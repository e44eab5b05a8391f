// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/bullet_stage.hpp>

#include <demos/compare/observed_world.hpp>
#include <demos/scenes/result_hash.hpp>
#include <demos/viewer/stage/body_shape.hpp>
#include <demos/viewer/stage/bullet_zones.hpp>

#include <integration/picking/pick.hpp>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr std::size_t kMostMarks = 2000;
constexpr float kRoomForAll = 500;  // around what is there, for axis sweeps [m]

Vector3<float> toEigen(const btVector3& vector) {
    return {vector.x(), vector.y(), vector.z()};
}

Aabb<float> boxOf(const btBroadphaseProxy& proxy) {
    return {toEigen(proxy.m_aabbMin), toEigen(proxy.m_aabbMax)};
}

Aabb<float> nowhere() {
    const Vector3<float> corner = Vector3<float>::Constant(std::numeric_limits<float>::quiet_NaN());
    return {corner, corner};
}

// What btCollisionWorld::updateSingleAabb() would set now.
Aabb<float> presentBox(const btRigidBody& body) {
    btVector3 low;
    btVector3 high;
    body.getAabb(low, high);
    const Vector3<float> margin = Vector3<float>::Constant(gContactBreakingThreshold);
    return {toEigen(low) - margin, toEigen(high) + margin};
}

// What everything stands on: a plane, or a slab of which the upper face is at height 0.
bool isGround(const btRigidBody& body) {
    const btCollisionShape& shape = *body.getCollisionShape();
    if (shape.getShapeType() == STATIC_PLANE_PROXYTYPE) {
        return true;
    }
    return body.getUserIndex() == 0 && body.isStaticObject() &&
           shape.getShapeType() == BOX_SHAPE_PROXYTYPE;
}

void takeShape(const btCollisionShape& shape, StageBody& body) {
    switch (shape.getShapeType()) {
        case SPHERE_SHAPE_PROXYTYPE:
            body.shape = StageBody::Shape::sphere;
            body.size.setConstant(static_cast<const btSphereShape&>(shape).getRadius());
            return;
        case CAPSULE_SHAPE_PROXYTYPE: {
            const auto& capsule = static_cast<const btCapsuleShape&>(shape);
            body.shape = StageBody::Shape::capsule;
            body.size = {capsule.getRadius(), capsule.getHalfHeight(), 0};
            // Drawn upright, along y.
            const int axis = capsule.getUpAxis();
            if (axis != 1) {
                body.orientation =
                    body.orientation *
                    Eigen::Quaternionf::FromTwoVectors(Vector3<float>::UnitY(),
                                                       Vector3<float>(Vector3<float>::Unit(axis)));
            }
            return;
        }
        case BOX_SHAPE_PROXYTYPE:
            body.shape = StageBody::Shape::box;
            body.size = toEigen(static_cast<const btBoxShape&>(shape).getHalfExtentsWithMargin());
            return;
        default: {
            btVector3 low;
            btVector3 high;
            shape.getAabb(btTransform::getIdentity(), low, high);
            body.shape = StageBody::Shape::box;
            body.size = toEigen((high - low) / 2);
        }
    }
}

}  // namespace

/// All that a world is made of, in the order in which it is made.
class BulletStage::World {
public:
    World(const BroadphaseKind& kind, const WorldSceneKind& scene, std::size_t objects,
          std::uint64_t seed)
        : dispatcher_(&configuration_),
          broadphase_(kind.make({.bounds = {}, .objects = objects})),
          world_(&dispatcher_, broadphase_.get(), &solver_, &configuration_),
          contents_(world_) {
        scene.fill(contents_, objects, seed);
        configurator_ = std::make_unique<WorldConfigurator>(world_);
    }

    [[nodiscard]] ObservedWorld& world() noexcept { return world_; }
    [[nodiscard]] const WorldContents& contents() const noexcept { return contents_; }
    [[nodiscard]] WorldConfigurator& configurator() noexcept { return *configurator_; }
    [[nodiscard]] btBroadphaseInterface& broadphase() noexcept { return *broadphase_; }
    [[nodiscard]] std::uint64_t memoryBytes() const noexcept {
        return static_cast<std::uint64_t>(
            std::max<std::int64_t>(world_.heap().bytes().value_or(0), 0));
    }

    /// Its joints go with it, and whoever leans on it wakes up.
    void remove(btRigidBody& body) {
        for (int i = world_.getNumConstraints() - 1; i >= 0; --i) {
            btTypedConstraint& joint = *world_.getConstraint(i);
            if (&joint.getRigidBodyA() == &body || &joint.getRigidBodyB() == &body) {
                joint.getRigidBodyA().activate();
                joint.getRigidBodyB().activate();
                world_.removeConstraint(&joint);
            }
        }
        for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
            const btPersistentManifold& contact = *dispatcher_.getManifoldByIndexInternal(i);
            if (contact.getBody0() == &body || contact.getBody1() == &body) {
                contact.getBody0()->activate();
                contact.getBody1()->activate();
            }
        }
        configurator_->release(body);
        world_.removeRigidBody(&body);
    }

    /// Gives every body a proxy of a new broadphase. Bodies have the indices of proxies that they would have
    /// if all had been added in their order, and those that were removed had been then.
    void replaceBroadphase(const BroadphaseKind& kind, const BroadphaseNeeds& needs) {
        const WorldEffects effects = configurator_->effects();
        configurator_ = nullptr;
        HeapMeter used;
        {
            const HeapScope scope(used);
            std::unique_ptr<btBroadphaseInterface> next = kind.make(needs);
            std::vector<btBroadphaseProxy*> removed;
            for (const auto& body : contents_.bodies()) {
                moveProxy(*body, *next, removed);
            }
            for (btBroadphaseProxy* proxy : removed) {
                next->destroyProxy(proxy, &dispatcher_);
            }
            world_.setBroadphase(next.get());
            broadphase_ = std::move(next);
        }
        world_.heap() = used;
        configurator_ = std::make_unique<WorldConfigurator>(world_);
        configurator_->apply(effects);
    }

private:
    void moveProxy(btRigidBody& body, btBroadphaseInterface& next,
                   std::vector<btBroadphaseProxy*>& removed) {
        btVector3 low;
        btVector3 high;
        body.getAabb(low, high);
        btBroadphaseProxy* before = body.getBroadphaseHandle();
        const CollisionFilter filter =
            before ? CollisionFilter{before->m_collisionFilterGroup, before->m_collisionFilterMask}
                   : CollisionFilter{0, 0};
        btBroadphaseProxy* proxy =
            next.createProxy(low, high, body.getCollisionShape()->getShapeType(), &body,
                             filter.group, filter.mask, &dispatcher_);
        if (before == nullptr) {
            removed.push_back(proxy);
            return;
        }
        broadphase_->getOverlappingPairCache()->cleanProxyFromPairs(before, &dispatcher_);
        broadphase_->destroyProxy(before, &dispatcher_);
        body.setBroadphaseHandle(proxy);
    }

    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_;
    btSequentialImpulseConstraintSolver solver_;
    std::unique_ptr<btBroadphaseInterface> broadphase_;
    ObservedWorld world_;
    WorldContents contents_;
    std::unique_ptr<WorldConfigurator> configurator_;
};

BulletStage::BulletStage(const WorldSceneKind& scene, std::size_t objects, std::uint64_t seed,
                         const SceneEffects& effects)
    : kind_(&broadphaseKinds().front()),
      world_(std::make_unique<World>(*kind_, scene, objects, seed)) {
    size_ = world_->contents().bodies().size();
    measureBounds();
    declare(effects);
    noteGivenBoxes();
}

BulletStage::~BulletStage() = default;

void BulletStage::measureBounds() {
    for (const auto& body : world_->contents().bodies()) {
        if (!isGround(*body)) {
            bounds_.extend(boxOf(*body->getBroadphaseHandle()));
        }
    }
    constexpr float kRoom = 10;  // [m]
    bounds_.extend(Vector3<float>(bounds_.max() + Vector3<float>(kRoom, 0, kRoom)));
    bounds_.extend(Vector3<float>(bounds_.min() - Vector3<float>(kRoom, 0, kRoom)));
    const float room = bounds_.sizes().maxCoeff();
    const Vector3<float> low(bounds_.min().x() - room, 0, bounds_.min().z() - room);
    const Vector3<float> high(bounds_.max().x() + room, 0, bounds_.max().z() + room);
    const Vector3<float> left(low.x(), 0, high.z());
    const Vector3<float> right(high.x(), 0, low.z());
    ground_ = {low, left, right, right, left, high};
}

// --- Frame ---------------------------------------------------------------------------------------

void BulletStage::step() {
    notePlaces();
    clock_.begin();
    {
        const BulletZones listening(zones_);
        world_->configurator().step(kFrameSeconds);
    }
    takeTimes(clock_.skip());
    noteGivenBoxes();
    clock_.skip();
    fileWhereBodiesAre();
    observers_.watchPhases([this](std::string_view phase) { clock_.end(phase); });
    observers_.observe({*grid()});
    findTunnelled();
}

// What Bullet says of itself. (Its zones take some time themselves.)
void BulletStage::takeTimes(double wholeMs) {
    constexpr std::array<std::pair<const char*, const char*>, 5> kPhases{{
        {"updateAabbs", "set boxes"},
        {"calculateOverlappingPairs", "find pairs"},
        {"dispatchAllCollisionPairs", "contacts"},
        {"solveConstraints", "solve"},
        {"integrateTransforms", "integrate"},
    }};
    double known = 0;
    for (const auto& [zone, phase] : kPhases) {
        const double milliseconds = millisecondsIn(zones_, zone);
        clock_.add(phase, milliseconds);
        known += milliseconds;
    }
    clock_.add("rest of the step", std::max(0.0, wholeMs - known));
}

// Of these the broadphase has found the pairs.
void BulletStage::noteGivenBoxes() {
    const auto bodies = world_->contents().bodies();
    given_.resize(bodies.size());
    for (std::uint32_t index = 0; index < bodies.size(); ++index) {
        const btRigidBody* body = bodyAt(index);
        given_[index] = body ? boxOf(*body->getBroadphaseHandle()) : nowhere();
    }
}

// Bullet sets boxes at the beginning of a step, and moves bodies at its end. Whoever looks asks where they are
// now. The next step begins with the same boxes; other broadphases than ours, which may pair whatever is set,
// are left alone.
void BulletStage::fileWhereBodiesAre() {
    if (second_ == nullptr) {
        world_->world().updateAabbs();
        clock_.end("boxes anew");
        return;
    }
    for (std::uint32_t index = 0; index < second_->proxies.size(); ++index) {
        if (const btRigidBody* body = bodyAt(index)) {
            second_->grid.move(second_->proxies[index], presentBox(*body));
        }
    }
    second_->grid.update();
    clock_.end("second index");
}

void BulletStage::notePlaces() {
    const auto bodies = world_->contents().bodies();
    before_.resize(bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        before_[i] = toEigen(bodies[i]->getWorldTransform().getOrigin());
    }
}

// Who has moved by more than its radius and has a wall between where it was and where it is.
void BulletStage::findTunnelled() {
    for (std::uint32_t index = 0; index < before_.size() && marks_.size() < kMostMarks; ++index) {
        const StageBody mover = body(index);
        const Vector3<float> way = mover.centre - before_[index];
        if (mover.shape != StageBody::Shape::sphere || mover.isStatic ||
            way.squaredNorm() <= mover.size.x() * mover.size.x()) {
            continue;
        }
        const RayRegion<float> path(before_[index], mover.centre);
        for (const Picked<float>& met : pickAll(*grid(), path, picked_)) {
            const StageBody wall = body(met.id.index);
            const bool isThrough = wall.shape == StageBody::Shape::box && wall.isStatic &&
                                   meets(wall, before_[index], way).value_or(0) > 0 &&
                                   meets(wall, mover.centre, -way).value_or(0) > 0;
            if (isThrough) {
                marks_.push_back({before_[index], mover.centre});
                break;
            }
        }
    }
}

// --- Who is there --------------------------------------------------------------------------------

btRigidBody* BulletStage::bodyAt(std::uint32_t index) const {
    const auto bodies = world_->contents().bodies();
    const bool isThere = index < bodies.size() && bodies[index]->getBroadphaseHandle() != nullptr;
    return isThere ? bodies[index].get() : nullptr;
}

std::uint32_t BulletStage::indexLimit() const {
    return static_cast<std::uint32_t>(world_->contents().bodies().size());
}

StageBody BulletStage::body(std::uint32_t index) const {
    StageBody seen;
    const btRigidBody* body = bodyAt(index);
    if (body == nullptr || isGround(*body)) {
        return seen;
    }
    const btTransform& place = body->getWorldTransform();
    const btQuaternion turn = place.getRotation();
    seen.centre = toEigen(place.getOrigin());
    seen.orientation = Eigen::Quaternionf(turn.w(), turn.x(), turn.y(), turn.z());
    seen.speed = body->getLinearVelocity().length();
    seen.isStatic = body->isStaticObject();
    seen.isAsleep = !seen.isStatic && !body->isActive();
    takeShape(*body->getCollisionShape(), seen);
    return seen;
}

std::size_t BulletStage::remove(std::span<const std::uint32_t> indices) {
    return static_cast<std::size_t>(std::count_if(
        indices.begin(), indices.end(), [this](std::uint32_t index) { return removeOne(index); }));
}

bool BulletStage::removeOne(std::uint32_t index) {
    btRigidBody* body = bodyAt(index);
    if (body == nullptr || isGround(*body)) {
        return false;
    }
    world_->remove(*body);
    observers_.forget(index);
    if (second_) {
        second_->grid.remove(second_->proxies[index]);
        second_->proxies[index] = {};
    }
    --size_;
    return true;
}

bool BulletStage::push(std::uint32_t index, const Vector3<float>& velocity) {
    btRigidBody* body = bodyAt(index);
    if (body == nullptr || body->isStaticObject()) {
        return false;
    }
    body->activate(true);
    body->setLinearVelocity(body->getLinearVelocity() +
                            btVector3(velocity.x(), velocity.y(), velocity.z()));
    return true;
}

std::uint64_t BulletStage::placesHash() const {
    ResultHash hash;
    for (std::uint32_t index = 0; index < world_->contents().bodies().size(); ++index) {
        if (const btRigidBody* body = bodyAt(index)) {
            hash.add(std::uint64_t{index});
            for (int row = 0; row < 3; ++row) {
                hash.add(toEigen(body->getWorldTransform().getBasis()[row]));
            }
            hash.add(toEigen(body->getWorldTransform().getOrigin()));
        }
    }
    return hash.value();
}

// --- What runs -----------------------------------------------------------------------------------

EffectSet BulletStage::possibleEffects() const {
    return EffectSet::all() - EffectSet{Effect::terrain};
}

void BulletStage::declare(const SceneEffects& effects) {
    const WorldEffects ofWorld = worldEffectsOf(effects);
    const bool isOtherGrid = effects.grid != effects_.grid;
    const bool hadColours = effects_.proximity.has_value();
    observers_.declare(effects);
    world_->configurator().apply(ofWorld);
    effects_ = effects;
    if (isOtherGrid) {
        fileAnew(*kind_);
    }
    colourAgents(hadColours);
}

void BulletStage::setBroadphase(const BroadphaseKind& kind) {
    if (&kind != kind_) {
        fileAnew(kind);
    }
}

// In that broadphase, and in the grid that is declared: its own, or the one beside it, for which a broadphase
// that has none stays as it is.
void BulletStage::fileAnew(const BroadphaseKind& kind) {
    if (kind.ours || &kind != kind_) {
        Aabb<float> room = bounds_;
        room.extend(Vector3<float>(room.max() + Vector3<float>::Constant(kRoomForAll)));
        room.extend(Vector3<float>(room.min() - Vector3<float>::Constant(kRoomForAll)));
        world_->replaceBroadphase(
            kind,
            {.bounds = room, .objects = world_->contents().bodies().size(), .grid = effects_.grid});
        kind_ = &kind;
    }
    observers_.forgetProxies();
    second_ = nullptr;
    if (!kind.ours) {
        makeSecondIndex();
    }
}

void BulletStage::makeSecondIndex() {
    second_ = std::make_unique<SecondIndex>(effects_.grid);
    const auto bodies = world_->contents().bodies();
    for (const auto& body : bodies) {
        second_->proxies.push_back(second_->grid.add(presentBox(*body)));
    }
    for (std::uint32_t index = 0; index < bodies.size(); ++index) {
        if (bodyAt(index) == nullptr) {
            second_->grid.remove(std::exchange(second_->proxies[index], {}));
        }
    }
}

const Grid<float>* BulletStage::grid() const {
    return second_ ? &second_->grid
                   : &dynamic_cast<const SpatialHashBroadphase&>(world_->broadphase()).grid();
}

void BulletStage::listPairs(std::vector<PairKey>& pairs) const {
    demos::listPairs(
        *world_->broadphase().getOverlappingPairCache(),
        [](const btBroadphaseProxy& proxy) {
            const auto* body = static_cast<btCollisionObject*>(proxy.m_clientObject);
            return static_cast<std::uint32_t>(body->getUserIndex());
        },
        pairs);
}

std::size_t BulletStage::pairCount() const {
    return static_cast<std::size_t>(
        world_->broadphase().getOverlappingPairCache()->getNumOverlappingPairs());
}

void BulletStage::listBoxes(std::vector<Aabb<float>>& boxes,
                            std::vector<CollisionFilter>& filters) const {
    boxes = given_;
    filters.clear();
    for (std::uint32_t index = 0; index < boxes.size(); ++index) {
        const btRigidBody* body = bodyAt(index);
        const btBroadphaseProxy* proxy = body ? body->getBroadphaseHandle() : nullptr;
        boxes[index] = proxy ? boxes[index] : nowhere();
        filters.push_back(
            proxy ? CollisionFilter{proxy->m_collisionFilterGroup, proxy->m_collisionFilterMask}
                  : CollisionFilter{});
    }
}

std::uint64_t BulletStage::memoryBytes() const {
    return world_->memoryBytes() + (second_ ? second_->grid.memoryBytes() : 0);
}

}  // namespace hashphase::demos
