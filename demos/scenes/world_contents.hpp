// SPDX-License-Identifier: Zlib
#pragma once

// What is in a Bullet world, owned: shapes, bodies, constraints, actions. Scenes fill it, and the same calls
// in the same order make identical worlds.

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <span>
#include <vector>

namespace hashphase::demos {

class WorldContents {
public:
    /// The world must outlive the contents, which leave it when they are destroyed.
    explicit WorldContents(btDynamicsWorld& world) : world_(world) {}
    WorldContents(const WorldContents&) = delete;
    WorldContents& operator=(const WorldContents&) = delete;
    ~WorldContents();

    [[nodiscard]] btDynamicsWorld& world() noexcept { return world_; }

    /// Keeps the shape; any number of bodies may share it.
    template <class Shape, class... Arguments>
    Shape& addShape(Arguments&&... arguments) {
        auto shape = std::make_unique<Shape>(std::forward<Arguments>(arguments)...);
        Shape& reference = *shape;
        shapes_.push_back(std::move(shape));
        return reference;
    }

    /// Adds a body of the given mass [kg], 0 for a static one, with Bullet's default filter. Bodies
    /// are numbered from 0; a body's number is its user index.
    btRigidBody& addBody(btCollisionShape& shape, btScalar mass, const btVector3& position);
    btRigidBody& addBody(btCollisionShape& shape, btScalar mass, const btTransform& place);

    /// By their numbers.
    [[nodiscard]] std::span<const std::unique_ptr<btRigidBody>> bodies() const noexcept {
        return bodies_;
    }

    /// Adds the constraint; bodies linked by it do not collide.
    void addConstraint(std::unique_ptr<btTypedConstraint> constraint);

    /// Adds what the world does besides, at the end of each step.
    void addAction(std::unique_ptr<btActionInterface> action);

    /// Keeps something else alive as long as the contents: an importer and its bytes, say.
    void keep(std::shared_ptr<void> owner) { owners_.push_back(std::move(owner)); }

private:
    btDynamicsWorld& world_;
    std::vector<std::unique_ptr<btCollisionShape>> shapes_;
    std::vector<std::unique_ptr<btRigidBody>> bodies_;
    std::vector<std::unique_ptr<btTypedConstraint>> constraints_;
    std::vector<std::unique_ptr<btActionInterface>> actions_;
    std::vector<std::shared_ptr<void>> owners_;
};

}  // namespace hashphase::demos
