// SPDX-License-Identifier: Zlib
#include <demos/scenes/penetration_meter.hpp>

#include <algorithm>
#include <vector>

namespace hashphase::demos {
namespace {

struct Box {
    btVector3 low;
    btVector3 high;
};

Box boxOf(const btRigidBody& body) {
    Box box;
    body.getAabb(box.low, box.high);
    return box;
}

bool doOverlap(const Box& a, const Box& b) {
    return TestAabbAgainstAabb2(a.low, a.high, b.low, b.high);
}

bool canPush(btRigidBody& a, btRigidBody& b) {
    return !(a.isStaticObject() && b.isStaticObject()) && a.hasContactResponse() &&
           b.hasContactResponse() && a.checkCollideWith(&b) && b.checkCollideWith(&a);
}

}  // namespace

double PenetrationMeter::deepest(const WorldContents& contents) {
    const auto bodies = contents.bodies();
    std::vector<Box> boxes;
    for (const auto& body : bodies) {
        boxes.push_back(boxOf(*body));
    }
    double most = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        for (std::size_t j = i + 1; j < bodies.size(); ++j) {
            if (doOverlap(boxes[i], boxes[j]) && canPush(*bodies[i], *bodies[j])) {
                most = std::max(most, depthOf(*bodies[i], *bodies[j]));
            }
        }
    }
    return most;
}

double PenetrationMeter::depthOf(const btCollisionObject& a, const btCollisionObject& b) {
    const btCollisionObjectWrapper wrapA(nullptr, a.getCollisionShape(), &a, a.getWorldTransform(),
                                         -1, -1);
    const btCollisionObjectWrapper wrapB(nullptr, b.getCollisionShape(), &b, b.getWorldTransform(),
                                         -1, -1);
    btCollisionAlgorithm* const algorithm =
        dispatcher_.findAlgorithm(&wrapA, &wrapB, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    btManifoldResult result(&wrapA, &wrapB);
    algorithm->processCollision(&wrapA, &wrapB, btDispatcherInfo(), &result);
    btManifoldArray manifolds;
    algorithm->getAllContactManifolds(manifolds);
    double most = 0;
    for (int i = 0; i < manifolds.size(); ++i) {
        for (int point = 0; point < manifolds[i]->getNumContacts(); ++point) {
            most = std::max(most, -double{manifolds[i]->getContactPoint(point).getDistance()});
        }
    }
    algorithm->~btCollisionAlgorithm();
    dispatcher_.freeCollisionAlgorithm(algorithm);
    return most;
}

}  // namespace hashphase::demos
