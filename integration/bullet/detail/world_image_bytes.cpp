// SPDX-License-Identifier: Zlib

// A world as bytes, and back: into a world that has the same objects. An object is known by the unique id of its
// proxy, a joint by its type and its bodies, a character by its ghost.

#include <integration/bullet/detail/world_image.hpp>

#include <broadphase/core/sealed_bytes.hpp>
#include <integration/bullet/detail/bullet_classes.hpp>
#include <integration/bullet/detail/bullet_members.hpp>
#include <integration/bullet/detail/joint_image.hpp>
#include <integration/bullet/detail/member_bytes.hpp>

#include <BulletDynamics/ConstraintSolver/btTypedConstraint.h>

#include <algorithm>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

constexpr Seal kWorldSeal{0x31737068'646c7277, 1, "a snapshot of a world"};

/// What is not in the world is taken from what is handed over, in its order.
template <class Item>
class HandedOver {
public:
    explicit HandedOver(std::span<Item* const> items) : items_(items) {}
    /// Null where there is none left.
    [[nodiscard]] Item* next() { return at_ < items_.size() ? items_[at_++] : nullptr; }

private:
    std::span<Item* const> items_;
    std::size_t at_ = 0;
};

btCollisionObject* theWorld() {
    return &btTypedConstraint::getFixedBody();
}

std::string contradiction(const char* what) {
    return std::string("The bytes of a snapshot of a world are invalid (") + what +
           "), so write() did not make them. Write the snapshot again.";
}

}  // namespace

// --- Writing -------------------------------------------------------------------------------------

std::string WorldImage::write(std::vector<std::byte>& bytes) const {
    if (broadphase.retiredCount() > 0) {
        return "Pairs were removed after the last step, and their algorithms are not freed yet. "
               "Step the world, then save and write it again.";
    }
    ObjectNumbers numbers;
    ObjectNumbers jointNumbers;
    for (const SavedObject& saved : objects) {
        numbers.add(saved.object);
    }
    numbers.add(theWorld());  // with which joints of one body link it
    for (const SavedJoint& saved : joints) {
        jointNumbers.add(saved.joint);
    }
    ByteWriter to;
    to.write(static_cast<std::uint8_t>(sizeof(btScalar)));
    to.write(BT_BULLET_VERSION);
    to.write(static_cast<std::uint32_t>(objects.size()));
    const void* const* pointer = pointers.data();
    bool areAllThere = true;
    const auto writeNumber = [&](const void* item, const ObjectNumbers& of) {
        const std::uint32_t number = of.of(item);
        to.write(number);
        areAllThere = areAllThere && number != ObjectNumbers::kNone;
    };
    const auto writeNumbers = [&](int count, const ObjectNumbers& of) {
        to.write(count);
        for (int i = 0; i < count; ++i) {
            writeNumber(*pointer++, of);
        }
    };
    for (const SavedObject& saved : objects) {
        to.write(saved.uniqueId);
        to.write(saved.proxyIndex);
        to.write(saved.type);
        to.write(saved.shapeRevision);
        writeNumbers(saved.ignoredCount, numbers);
        writeNumbers(saved.jointCount, jointNumbers);
        writeNumbers(saved.overlappingCount, numbers);
        to.write(saved.ghostPairCount);
    }
    to.write(static_cast<std::uint32_t>(bodies.size()));
    for (const btRigidBody* body : bodies) {
        to.write(numbers.of(static_cast<const btCollisionObject*>(body)));
    }
    to.write(static_cast<std::uint32_t>(joints.size()));
    for (const SavedJoint& saved : joints) {
        to.write(saved.type);
        writeNumber(static_cast<const btCollisionObject*>(saved.a), numbers);
        writeNumber(static_cast<const btCollisionObject*>(saved.b), numbers);
    }
    to.write(static_cast<std::uint32_t>(actions.size()));
    for (btActionInterface* action : actions) {
        const btCollisionObject* const ghost = asCharacter(action)->getGhostObject();
        writeNumber(ghost, numbers);
    }
    if (!areAllThere || !broadphase.areClientsAmong(numbers)) {
        return "Something that the world refers to is not in it: an ignored object, a joint of a "
               "body, a body of a joint, the ghost of a character, or the object of a proxy. Add "
               "it, or drop the reference, and save again.";
    }
    broadphase.write(to, numbers);
    ghosts.write(to);
    contacts.write(to, numbers);
    to.write(fields.bytes().data(), fields.bytes().size());
    sealBytes(kWorldSeal, to.bytes(), bytes);
    return {};
}

// --- Reading -------------------------------------------------------------------------------------

std::string WorldImage::read(std::span<const std::byte> bytes, btDiscreteDynamicsWorld& world,
                             const SpatialHashBroadphase& ofBroadphase, const Returned& returned) {
    std::span<const std::byte> content;
    std::string fault = openBytes(kWorldSeal, bytes, content);
    if (!fault.empty()) {
        return fault;
    }
    ByteReader from(content);
    if (from.read<std::uint8_t>() != sizeof(btScalar) ||
        from.read<std::int32_t>() != BT_BULLET_VERSION) {
        return "The bytes are a snapshot of a world of another Bullet: of the other precision, or "
               "of another version. Read them with the Bullet that wrote them.";
    }
    fault = readObjects(from, world, returned);
    if (fault.empty()) {
        fault = readJoints(from, world, returned);
    }
    if (fault.empty()) {
        fault = readActions(from, world, returned);
    }
    if (!fault.empty()) {
        return fault;
    }
    std::vector<btCollisionObject*> numbered;
    for (const SavedObject& saved : objects) {
        numbered.push_back(saved.object);
    }
    fault = broadphase.read(from, numbered, ofBroadphase);
    if (!fault.empty()) {
        return "The bytes of a snapshot of a world do not fit. " + fault;
    }
    if (!ghosts.read(from, broadphase) || !areProxiesRight() || !areGhostsRight()) {
        return contradiction("proxies");
    }
    if (!contacts.read(from, numbered, objectsOfPairs())) {
        return contradiction("contacts");
    }
    if (from.left() != countFieldBytes(world)) {
        return contradiction("objects");
    }
    fields.clear();
    fields.write(from.rest().data(), from.left());
    saveSettings(world);
    return {};
}

std::string WorldImage::readObjects(ByteReader& from, btDiscreteDynamicsWorld& world,
                                    const Returned& returned) {
    const auto count = from.read<std::uint32_t>();
    constexpr std::size_t kLeast = 8 * sizeof(int);
    if (count > from.left() / kLeast) {
        return contradiction("objects");
    }
    const btCollisionObjectArray& all = world.getCollisionObjectArray();
    FlatSet uniqueIds;  // of those in the world, in its order
    for (int i = 0; i < all.size(); ++i) {
        uniqueIds.findOrInsert(
            static_cast<std::uint32_t>(all[i]->getBroadphaseHandle()->m_uniqueId));
    }
    HandedOver<btCollisionObject> handedOver(returned.objects);
    std::vector<std::uint32_t> numbers;  // of lists, in the order of `pointers`
    std::string away;                    // unique ids, of those that are not in the world
    std::string fault;
    for (std::uint32_t i = 0; i < count; ++i) {
        SavedObject saved{};
        saved.uniqueId = from.read<int>();
        saved.proxyIndex = from.read<std::uint32_t>();
        saved.type = from.read<int>();
        saved.shapeRevision = from.read<int>();
        for (int* listCount : {&saved.ignoredCount, &saved.jointCount, &saved.overlappingCount}) {
            *listCount = from.read<int>();
            if (*listCount < 0 ||
                static_cast<std::size_t>(*listCount) > from.left() / sizeof(std::uint32_t)) {
                return contradiction("objects");
            }
            for (int k = 0; k < *listCount; ++k) {
                numbers.push_back(from.read<std::uint32_t>());
            }
        }
        saved.ghostPairCount = from.read<int>();
        const std::uint32_t place = uniqueIds.find(static_cast<std::uint32_t>(saved.uniqueId));
        saved.object = place != FlatSet::kNone ? all[static_cast<int>(place)] : handedOver.next();
        if (place == FlatSet::kNone) {
            away += (away.empty() ? "" : ", ") + std::to_string(saved.uniqueId);
        }
        if (saved.object == nullptr) {
            continue;
        }
        if (fault.empty() &&
            (saved.object->getInternalType() != saved.type ||
             shapeRevisionOf(saved.object->getCollisionShape()) != saved.shapeRevision)) {
            fault = "The object with the unique id " + std::to_string(saved.uniqueId) +
                    " has another type or compound shape than the saved one. Build both worlds by "
                    "the same calls.";
        }
        saved.shape = saved.object->getCollisionShape();
        saved.rootShape = saved.shape;
        objects.push_back(saved);
    }
    if (objects.size() < count) {
        return "Objects are not in the world. Hand them over as Returned::objects, in the order of "
               "these unique ids: " +
               away + ".";
    }
    if (fault.empty() && !areDistinct()) {
        fault = contradiction("objects");
    }
    return fault.empty() ? takeNumbers(from, numbers) : fault;
}

bool WorldImage::areDistinct() const {
    FlatSet known;
    for (const SavedObject& saved : objects) {
        known.findOrInsert(reinterpret_cast<std::uintptr_t>(saved.object));
    }
    return known.size() == objects.size();
}

// Lists have joints, too, which are read later: their numbers stay in `pointers` until then.
std::string WorldImage::takeNumbers(ByteReader& from, std::span<const std::uint32_t> numbers) {
    std::size_t at = 0;
    for (const SavedObject& saved : objects) {
        const bool isBody = btRigidBody::upcast(saved.object) != nullptr;
        const bool isGhost = btGhostObject::upcast(saved.object) != nullptr;
        if ((!isBody && saved.jointCount > 0) || (!isGhost && saved.overlappingCount > 0)) {
            return contradiction("objects");
        }
        const auto take = [&](int count, bool areObjects, std::size_t most) {
            for (int i = 0; i < count; ++i, ++at) {
                if (areObjects && numbers[at] > most) {
                    return false;
                }
                pointers.push_back(!areObjects                    ? nullptr
                                   : numbers[at] < objects.size() ? objects[numbers[at]].object
                                                                  : theWorld());
            }
            return true;
        };
        // Only the body that stands for the world, which has the last number, may be no object of it.
        const bool isSound = take(saved.ignoredCount, true, objects.size());
        const std::size_t firstJoint = at;
        if (!isSound || !take(saved.jointCount, false, 0) ||
            !take(saved.overlappingCount, true, objects.size() - 1)) {
            return contradiction("objects");
        }
        for (int i = 0; i < saved.jointCount; ++i) {
            jointPlaces_.push_back({firstJoint + static_cast<std::size_t>(i),
                                    numbers[firstJoint + static_cast<std::size_t>(i)]});
        }
    }
    const auto bodyCount = from.read<std::uint32_t>();
    ObjectNumbers known;
    for (std::uint32_t i = 0; i < bodyCount && !from.isTorn(); ++i) {
        const auto number = from.read<std::uint32_t>();
        btRigidBody* const body =
            number < objects.size() ? btRigidBody::upcast(objects[number].object) : nullptr;
        if (body == nullptr || known.has(body)) {
            return contradiction("bodies");
        }
        known.add(body);
        bodies.push_back(body);
    }
    return {};
}

std::string WorldImage::readJoints(ByteReader& from, btDiscreteDynamicsWorld& world,
                                   const Returned& returned) {
    const auto count = from.read<std::uint32_t>();
    const auto& all = WorldMembers::joints(world);
    std::vector<char> isTaken(static_cast<std::size_t>(all.size()), 0);
    HandedOver<btTypedConstraint> handedOver(returned.joints);
    int begin = 0;  // of the search: mostly they are in the same order
    for (std::uint32_t i = 0; i < count; ++i) {
        const int type = from.read<int>();
        const auto a = from.read<std::uint32_t>();
        const auto b = from.read<std::uint32_t>();
        if (from.isTorn()) {
            return contradiction("joints");
        }
        const auto isBetween = [&](btTypedConstraint& joint) {
            const auto isBody = [&](const btRigidBody& body, std::uint32_t number) {
                return &body == (number < objects.size() ? objects[number].object : theWorld());
            };
            return joint.getConstraintType() == type && isBody(joint.getRigidBodyA(), a) &&
                   isBody(joint.getRigidBodyB(), b);
        };
        btTypedConstraint* found = nullptr;
        for (int k = 0; k < all.size() && found == nullptr; ++k) {
            const int at = (begin + k) % all.size();
            if (isTaken[static_cast<std::size_t>(at)] == 0 && isBetween(*all[at])) {
                isTaken[static_cast<std::size_t>(at)] = 1;
                found = all[at];
                begin = at + 1;
            }
        }
        found = found != nullptr ? found : handedOver.next();
        if (found == nullptr || !isBetween(*found) || !isKnown(*found)) {
            return "Joint " + std::to_string(i) +
                   " is not in the world: no joint there has its type and bodies. Hand it over as "
                   "Returned::joints.";
        }
        joints.push_back({found, type, &found->getRigidBodyA(), &found->getRigidBodyB()});
    }
    for (const auto& [place, number] : jointPlaces_) {
        if (number >= joints.size()) {
            return contradiction("joints");
        }
        pointers[place] = joints[number].joint;
    }
    return {};
}

std::string WorldImage::readActions(ByteReader& from, btDiscreteDynamicsWorld& world,
                                    const Returned& returned) {
    const auto count = from.read<std::uint32_t>();
    const auto& all = WorldMembers::actions(world);
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto number = from.read<std::uint32_t>();
        if (number >= objects.size()) {
            return contradiction("characters");
        }
        const auto isOf = [&](btActionInterface* action) {
            btKinematicCharacterController* const character = asCharacter(action);
            const btCollisionObject* const ghost =
                character != nullptr ? character->getGhostObject() : nullptr;
            return ghost == objects[number].object;
        };
        btActionInterface* found = nullptr;
        for (int k = 0; k < all.size(); ++k) {
            found = isOf(all[k]) ? all[k] : found;
        }
        for (btActionInterface* action : returned.actions) {
            found = isOf(action) ? action : found;
        }
        if (found == nullptr || std::find(actions.begin(), actions.end(), found) != actions.end()) {
            return "Action " + std::to_string(i) +
                   ", the character of the ghost with the unique id " +
                   std::to_string(objects[number].uniqueId) +
                   ", is not in the world. Hand it over as Returned::actions.";
        }
        actions.push_back(found);
    }
    return {};
}

bool WorldImage::areProxiesRight() const {
    std::size_t ghostPairs = 0;
    for (const SavedObject& saved : objects) {
        btGhostObject* const ghost = btGhostObject::upcast(saved.object);
        const bool keepsPairs = ghost != nullptr && asPairCachingGhost(ghost) != nullptr;
        if (saved.ghostPairCount < 0 || (!keepsPairs && saved.ghostPairCount > 0) ||
            broadphase.clientOf(saved.proxyIndex) != saved.object) {
            return false;
        }
        ghostPairs += static_cast<std::size_t>(saved.ghostPairCount);
    }
    return ghostPairs == ghosts.pairs().size();
}

// What a ghost overlaps is a pair of the broadphase; and so are the pairs that it keeps, each once, of which it is
// one of the two. Bullet takes them out with those.
bool WorldImage::areGhostsRight() const {
    FlatSet paired;
    const auto keyOf = [](std::uint32_t a, std::uint32_t b) {
        return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
    };
    for (const BroadphaseImage::Pair& pair : broadphase.pairs()) {
        paired.findOrInsert(keyOf(pair.first, pair.second));
    }
    ObjectNumbers numbers;
    for (const SavedObject& saved : objects) {
        numbers.add(saved.object);
    }
    const void* const* pointer = pointers.data();
    std::span<const BroadphaseImage::Pair> ghostPairs = ghosts.pairs();
    FlatSet met;
    for (const SavedObject& saved : objects) {
        pointer += saved.ignoredCount + saved.jointCount;
        const auto isNewPair = [&](std::uint32_t other) {
            const std::uint64_t key = keyOf(saved.proxyIndex, other);
            const bool isNew = !met.contains(key);
            met.findOrInsert(key);
            return isNew && paired.contains(key);
        };
        met.clear();
        for (int i = 0; i < saved.overlappingCount; ++i, ++pointer) {
            if (!isNewPair(objects[numbers.of(*pointer)].proxyIndex)) {
                return false;
            }
        }
        met.clear();
        for (int i = 0; i < saved.ghostPairCount; ++i) {
            const BroadphaseImage::Pair& pair = ghostPairs[static_cast<std::size_t>(i)];
            const bool isFirst = pair.first == saved.proxyIndex;
            if ((!isFirst && pair.second != saved.proxyIndex) ||
                !isNewPair(isFirst ? pair.second : pair.first)) {
                return false;
            }
        }
        ghostPairs = ghostPairs.subspan(static_cast<std::size_t>(saved.ghostPairCount));
    }
    return true;
}

std::vector<ObjectPair> WorldImage::objectsOfPairs() const {
    std::vector<ObjectPair> all;
    for (const std::span<const BroadphaseImage::Pair> pairs :
         {broadphase.pairs(), ghosts.pairs()}) {
        for (const BroadphaseImage::Pair& pair : pairs) {
            all.push_back({broadphase.clientOf(pair.first), broadphase.clientOf(pair.second)});
        }
    }
    return all;
}

std::size_t WorldImage::countFieldBytes(btDiscreteDynamicsWorld& world) const {
    std::size_t bytes = bytesOf(world) + sizeof(std::uint64_t);
    for (const SavedObject& saved : objects) {
        bytes += bytesOf(*saved.object);
    }
    ByteWriter ofJoints;
    for (const SavedJoint& saved : joints) {
        saveJoint(*saved.joint, ofJoints);
    }
    for (btActionInterface* action : actions) {
        bytes += bytesOf(*asCharacter(action));
    }
    return bytes + ofJoints.bytes().size();
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
