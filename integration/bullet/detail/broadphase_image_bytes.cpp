// SPDX-License-Identifier: Zlib

// A broadphase as bytes, and back. Groups, and what else follows from proxies and clients, is found again.

#include <integration/bullet/detail/broadphase_image.hpp>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include <algorithm>
#include <array>
#include <limits>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

void write(const btVector3& corner, ByteWriter& to) {
    for (int axis = 0; axis < 3; ++axis) {
        to.write(corner[axis]);
    }
}

btVector3 readCorner(ByteReader& from) {
    std::array<btScalar, 3> corner{};
    for (btScalar& coordinate : corner) {
        coordinate = from.read<btScalar>();
    }
    return {corner[0], corner[1], corner[2]};
}

bool isRepeated(std::vector<std::uint64_t>& numbers) {
    std::sort(numbers.begin(), numbers.end());
    return std::adjacent_find(numbers.begin(), numbers.end()) != numbers.end();
}

}  // namespace

bool BroadphaseImage::areClientsAmong(const ObjectNumbers& numbers) const {
    return std::ranges::all_of(proxies_, [&](const Broadphase::Proxy& proxy) {
        return proxy.id.isNull() || numbers.has(proxy.m_clientObject);
    });
}

void BroadphaseImage::write(ByteWriter& to, const ObjectNumbers& numbers) const {
    std::vector<std::byte> grid;
    grid_.write(grid);
    to.write(static_cast<std::uint64_t>(grid.size()));
    to.write(grid.data(), grid.size());
    to.write(lastUniqueId_);
    to.write(groupsDecide_);
    to.write(isCacheBehind_);
    to.write(mayGrow_);
    to.write(isMoreTakenOut_);
    for (std::uint32_t index = 0; index < proxies_.size(); ++index) {
        const Broadphase::Proxy& proxy = proxies_[index];
        to.write(uniqueIds_[index]);
        if (uniqueIds_[index] == 0) {
            continue;
        }
        to.write(numbers.of(proxy.m_clientObject));
        to.write(proxy.m_collisionFilterGroup);
        to.write(proxy.m_collisionFilterMask);
        detail::write(proxy.m_aabbMin, to);
        detail::write(proxy.m_aabbMax, to);
        to.write(proxy.margin);
        to.write(proxy.client);
    }
    writePairs(pairs_, to);
    writePairs(takenOut_, to);
}

std::string BroadphaseImage::read(ByteReader& from, std::span<btCollisionObject* const> objects,
                                  const SpatialHashBroadphase& broadphase) {
    const auto gridSize = from.read<std::uint64_t>();
    if (gridSize > from.left()) {
        return "They end too soon. Pass all that write() made.";
    }
    std::string fault = grid_.read(from.rest().first(static_cast<std::size_t>(gridSize)));
    from.skip(static_cast<std::size_t>(gridSize));
    if (fault.empty()) {
        fault = grid_.faultFor(broadphase.pairs_);
    }
    if (!fault.empty()) {
        return fault;
    }
    lastUniqueId_ = from.read<int>();
    groupsDecide_ = from.read<std::uint8_t>() != 0;
    isCacheBehind_ = from.read<std::uint8_t>() != 0;
    mayGrow_ = from.read<std::uint8_t>() != 0;
    isMoreTakenOut_ = from.read<std::uint8_t>() != 0;
    const bool isSound = readProxies(from, objects) && readPairs(from, pairs_) &&
                         readPairs(from, takenOut_) && !from.isTorn();
    mustNoteGroups_ = true;
    changedKinds_ = ~GroupKinds::Set{0};
    seen_.clear();
    seenCount_ = 0;
    retired_.clear();
    isSorted_ = false;
    return isSound ? std::string()
                   : "Their proxies or pairs are invalid. Write the snapshot again.";
}

bool BroadphaseImage::readProxies(ByteReader& from, std::span<btCollisionObject* const> objects) {
    proxies_.assign(grid_.indexLimit(), {});
    uniqueIds_.assign(grid_.indexLimit(), 0);
    groupKinds_ = GroupKinds();
    ghosts_.reset();
    std::vector<std::uint64_t> known;
    for (std::uint32_t index = 0; index < proxies_.size(); ++index) {
        uniqueIds_[index] = from.read<int>();
        const ProxyId id = grid_.idAt(index);
        if ((uniqueIds_[index] == 0) != id.isNull()) {
            return false;
        }
        if (id.isNull()) {
            continue;
        }
        Broadphase::Proxy& proxy = proxies_[index];
        const auto number = from.read<std::uint32_t>();
        proxy.m_collisionFilterGroup = from.read<int>();
        proxy.m_collisionFilterMask = from.read<int>();
        proxy.m_aabbMin = readCorner(from);
        proxy.m_aabbMax = readCorner(from);
        proxy.margin = from.read<btScalar>();
        proxy.client = from.read<Broadphase::Client>();
        proxy.m_uniqueId = uniqueIds_[index];
        proxy.id = id;
        const bool isGhost = proxy.client == Broadphase::Client::ghost;
        if (number >= objects.size() || proxy.m_uniqueId < 1 || proxy.m_uniqueId > lastUniqueId_ ||
            !(proxy.margin >= 0 && proxy.margin <= std::numeric_limits<btScalar>::max()) ||
            proxy.client > Broadphase::Client::other ||
            (isGhost && objects[number]->getInternalType() != btCollisionObject::CO_GHOST_OBJECT)) {
            return false;
        }
        proxy.m_clientObject = objects[number];
        known.push_back(static_cast<std::uint64_t>(proxy.m_uniqueId));
        known.push_back((std::uint64_t{1} << 32) + number);
        const ProxyGroups groups{static_cast<std::uint32_t>(proxy.m_collisionFilterGroup),
                                 static_cast<std::uint32_t>(proxy.m_collisionFilterMask)};
        proxy.kind = groupKinds_.numberOf(groupsDecide_ ? groups : ProxyGroups{});
        if (isGhost) {
            if (ghosts_ == nullptr) {
                ghosts_ = std::make_unique<FlatSet>();
            }
            ghosts_->findOrInsert(index);
        }
    }
    return known.size() == 2 * objects.size() && !isRepeated(known);
}

const btCollisionObject* BroadphaseImage::clientOf(std::uint32_t index) const noexcept {
    return index < proxies_.size()
               ? static_cast<const btCollisionObject*>(proxies_[index].m_clientObject)
               : nullptr;
}

void BroadphaseImage::writePairs(std::span<const Pair> pairs, ByteWriter& to) {
    to.write(static_cast<std::uint32_t>(pairs.size()));
    for (const Pair& pair : pairs) {
        to.write(pair.first);
        to.write(pair.second);
    }
}

bool BroadphaseImage::readPairs(ByteReader& from, std::vector<Pair>& pairs) const {
    const auto count = from.read<std::uint32_t>();
    pairs.clear();
    if (count > from.left() / (2 * sizeof(std::uint32_t))) {
        return false;
    }
    std::vector<std::uint64_t> known;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto first = from.read<std::uint32_t>();
        const auto second = from.read<std::uint32_t>();
        if (first == second || first >= proxies_.size() || second >= proxies_.size() ||
            uniqueIds_[first] == 0 || uniqueIds_[second] == 0) {
            return false;
        }
        pairs.push_back({first, second, nullptr});
        known.push_back(std::uint64_t{std::min(first, second)} << 32 | std::max(first, second));
    }
    return !isRepeated(known);
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
