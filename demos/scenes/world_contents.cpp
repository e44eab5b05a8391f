// SPDX-License-Identifier: Zlib
#include <demos/scenes/world_contents.hpp>

#include <utility>

namespace hashphase::demos {

WorldContents::~WorldContents() {
    owners_.clear();
    for (const auto& action : actions_) {
        world_.removeAction(action.get());
    }
    for (const auto& constraint : constraints_) {
        world_.removeConstraint(constraint.get());
    }
    // Last in, first out: a world finds its last body at once.
    for (; !bodies_.empty(); bodies_.pop_back()) {
        world_.removeRigidBody(bodies_.back().get());
    }
}

btRigidBody& WorldContents::addBody(btCollisionShape& shape, btScalar mass,
                                    const btVector3& position) {
    return addBody(shape, mass, btTransform(btMatrix3x3::getIdentity(), position));
}

btRigidBody& WorldContents::addBody(btCollisionShape& shape, btScalar mass,
                                    const btTransform& place) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) {
        shape.calculateLocalInertia(mass, inertia);
    }
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, &shape, inertia);
    info.m_startWorldTransform = place;
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    bodies_.back()->setUserIndex(static_cast<int>(bodies_.size()) - 1);
    world_.addRigidBody(bodies_.back().get());
    return *bodies_.back();
}

void WorldContents::addConstraint(std::unique_ptr<btTypedConstraint> constraint) {
    world_.addConstraint(constraint.get(), true);
    constraints_.push_back(std::move(constraint));
}

void WorldContents::addAction(std::unique_ptr<btActionInterface> action) {
    world_.addAction(action.get());
    actions_.push_back(std::move(action));
}

}  // namespace hashphase::demos
