// SPDX-License-Identifier: Zlib
#include <demos/viewer/stage/bullet_stage.hpp>

#include <demos/compare/trial.hpp>
#include <demos/scenes/result_hash.hpp>

#include <integration/bullet/conversions.hpp>
#include <integration/bullet/spatial_hash_broadphase.hpp>
#include <integration/effects/bullet_frame.hpp>
#include <integration/picking/pick.hpp>

#include <algorithm>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr float kRoomForAll = 500;           // around what is there, for axis sweeps [m]
constexpr std::ptrdiff_t kMostMarks = 2000;  // of tunnels: the last ones
constexpr std::uint64_t kMarkFrames = 15;    // in which each is shown

Aabb<float> boxOf(const btBroadphaseProxy& proxy) {
    return toAabb(proxy.m_aabbMin, proxy.m_aabbMax);
}

// What btCollisionWorld::updateSingleAabb() would set now.
Aabb<float> presentBox(const btRigidBody& body) {
    btVector3 low;
    btVector3 high;
    body.getAabb(low, high);
    const Vector3<float> margin = Vector3<float>::Constant(gContactBreakingThreshold);
    return {toEigen(low) - margin, toEigen(high) + margin};
}

/// Whether a sphere has moved by more than its radius. One that is farther than its speed takes it was put there.
bool hasFlown(const StageBody& sphere, const Vector3<float>& before) {
    const float radius = sphere.size.x();
    const float way = (sphere.centre - before).norm();
    return way > radius && way <= 2 * sphere.speed * kFrameSeconds + radius;
}

/// The time of all zones of that name that lie in none of the same name [ms].
double millisecondsIn(std::span<const ProfileZone> zones, std::string_view name) {
    double sum = 0;
    int depthOfLast = -1;  // within that one nothing counts again
    for (const ProfileZone& zone : zones) {
        if (depthOfLast >= 0 && zone.depth > depthOfLast) {
            continue;
        }
        depthOfLast = zone.name == name ? zone.depth : -1;
        sum += zone.name == name ? zone.milliseconds : 0;
    }
    return sum;
}

}  // namespace

BulletStage::BulletStage(const WorldSceneKind& scene, std::size_t objects, std::uint64_t seed)
    : Stage({}, EffectSet::all() - EffectSet{Effect::terrain, Effect::zones}),
      world_(std::make_unique<BulletWorld>(broadphase(), scene, objects, seed)) {
    observers_ = &ownObservers_;
    size_ = world_->contents.bodies().size();
    measureBounds();
    declare(effectsOf({Effect::motion, Effect::pairs, Effect::response, Effect::sleeping,
                       Effect::rotation, Effect::friction, Effect::picking, Effect::boxSelection,
                       Effect::culling}));
    noteGivenBoxes();
}

void BulletStage::measureBounds() {
    for (const auto& body : world_->contents.bodies()) {
        if (!isGround(*body)) {
            bounds_.extend(boxOf(*body->getBroadphaseHandle()));
        }
    }
    bounds_ = withRoom(bounds_, {10, 0, 10});
    const float room = bounds_.sizes().maxCoeff();
    const Aabb<float> wide = withRoom(bounds_, Vector3<float>::Constant(room));
    const Vector3<float> low(wide.min().x(), 0, wide.min().z());
    const Vector3<float> high(wide.max().x(), 0, wide.max().z());
    const Vector3<float> left(low.x(), 0, high.z());
    const Vector3<float> right(high.x(), 0, low.z());
    ground_ = {low, left, right, right, left, high};
}

// --- Frame ---------------------------------------------------------------------------------------

void BulletStage::runFrame() {
    before_.resize(indexLimit());
    for (std::uint32_t index = 0; index < before_.size(); ++index) {
        before_[index] = body(index).centre;
    }
    clock_.begin();
    zones_ = world_->step();
    takeTimes(clock_.skip());
    noteGivenBoxes();
    clock_.skip();
    fileWhereBodiesAre();
    ownObservers_.watchPhases([this](std::string_view phase) { clock_.end(phase); });
    ownObservers_.observe({*grid()});
    markTunnels();
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
    clock_.add("other", std::max(0.0, wholeMs - known));
}

// Of these the broadphase has found the pairs.
void BulletStage::noteGivenBoxes() {
    const auto bodies = world_->contents.bodies();
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
        world_->world.updateAabbs();
        clock_.end("update boxes");
        return;
    }
    for (std::uint32_t index = 0; index < second_->proxies.size(); ++index) {
        if (const btRigidBody* body = bodyAt(index)) {
            second_->grid.move(second_->proxies[index], presentBox(*body));
        }
    }
    second_->grid.update();
    clock_.end("viewer's grid");
}

// Marks spheres that have moved by more than their radius and have a static box between where they were and
// where they are. Cost: a ray for each sphere that is so fast.
void BulletStage::markTunnels() {
    ++frame_;
    std::erase_if(tunnelMarks_,
                  [this](const TunnelMark& mark) { return mark.frame + kMarkFrames <= frame_; });
    std::vector<Picked<float>> picked;
    for (std::uint32_t index = 0; index < before_.size(); ++index) {
        const StageBody mover = body(index);
        if (mover.shape != StageBody::Shape::sphere || mover.isStatic ||
            !hasFlown(mover, before_[index])) {
            continue;
        }
        const Vector3<float> way = mover.centre - before_[index];
        pickAll(*grid(), RayRegion<float>(before_[index], mover.centre), picked);
        const bool isThrough = std::ranges::any_of(picked, [&](const Picked<float>& met) {
            const StageBody wall = body(met.id.index);
            return wall.shape == StageBody::Shape::box && wall.isStatic &&
                   meets(wall, before_[index], way).value_or(0) > 0 &&
                   meets(wall, mover.centre, -way).value_or(0) > 0;
        });
        if (isThrough) {
            ++tunnelCount_;
            tunnelMarks_.push_back({before_[index], mover.centre, frame_});
        }
    }
    if (std::ssize(tunnelMarks_) > kMostMarks) {
        tunnelMarks_.erase(tunnelMarks_.begin(), tunnelMarks_.end() - kMostMarks);
    }
}

// --- Who is there --------------------------------------------------------------------------------

btRigidBody* BulletStage::bodyAt(std::uint32_t index) const {
    const auto bodies = world_->contents.bodies();
    const bool isThere = index < bodies.size() && bodies[index]->getBroadphaseHandle() != nullptr;
    return isThere ? bodies[index].get() : nullptr;
}

std::uint32_t BulletStage::indexLimit() const {
    return static_cast<std::uint32_t>(world_->contents.bodies().size());
}

StageBody BulletStage::body(std::uint32_t index) const {
    const btRigidBody* body = bodyAt(index);
    return body == nullptr || isGround(*body) ? StageBody() : stageBody(*body);
}

bool BulletStage::removeOne(std::uint32_t index) {
    btRigidBody* body = bodyAt(index);
    if (body == nullptr || isGround(*body)) {
        return false;
    }
    world_->remove(*body);
    ownObservers_.forget(index);
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
    for (std::uint32_t index = 0; index < world_->contents.bodies().size(); ++index) {
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

std::string BulletStage::faultOf(const SceneEffects& effects) const {
    return bulletEffectsError(effects);
}

void BulletStage::follow(const SceneEffects& before) {
    ownObservers_.declare(effects());
    world_->apply(worldEffectsOf(effects()));
    if (effects().grid != before.grid) {
        fileAnew(broadphase());
    }
}

// In that broadphase, and in the grid that is declared: its own, or the one beside it, for which a broadphase
// that has none stays as it is.
void BulletStage::fileAnew(const BroadphaseKind& kind) {
    if (kind.ours || &kind != &broadphase()) {
        world_->replaceBroadphase(
            kind, {.bounds = withRoom(bounds_, Vector3<float>::Constant(kRoomForAll)),
                   .objects = world_->contents.bodies().size(),
                   .grid = effects().grid});
    }
    ownObservers_.forgetProxies();
    second_ = nullptr;
    if (!kind.ours) {
        makeSecondIndex();
    }
}

void BulletStage::makeSecondIndex() {
    second_ = std::make_unique<SecondIndex>(effects().grid);
    const auto bodies = world_->contents.bodies();
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
                   : &dynamic_cast<const SpatialHashBroadphase&>(*world_->broadphase).grid();
}

void BulletStage::listPairs(std::vector<PairKey>& pairs) const {
    demos::listPairs(
        *world_->broadphase->getOverlappingPairCache(),
        [](const btBroadphaseProxy& proxy) {
            const auto* body = static_cast<btCollisionObject*>(proxy.m_clientObject);
            return static_cast<std::uint32_t>(body->getUserIndex());
        },
        pairs);
}

std::size_t BulletStage::pairCount() const {
    return static_cast<std::size_t>(
        world_->broadphase->getOverlappingPairCache()->getNumOverlappingPairs());
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

std::optional<std::int64_t> BulletStage::memoryBytes() const {
    return sumOf(second_ ? second_->grid.memoryBytes() : 0, world_->memoryBytes());
}

}  // namespace hashphase::demos
