// SPDX-License-Identifier: Zlib

// Contacts as bytes, and back.

#include <integration/bullet/detail/contact_image.hpp>

#include <broadphase/core/flat_set.hpp>
#include <integration/bullet/detail/algorithm_kind.hpp>
#include <integration/bullet/detail/bullet_members.hpp>
#include <integration/bullet/detail/member_bytes.hpp>

#include <BulletCollision/CollisionShapes/btCompoundShape.h>

#include <algorithm>
#include <array>
#include <utility>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
/// Goes through what algorithms own as restore() does.
class ContactImage::Checker {
public:
    explicit Checker(const ContactImage& image) : image_(image) {}

    [[nodiscard]] bool isAlgorithm(const ObjectPair& pair) {
        pair_ = pair;
        return isAlgorithm(*pair.a->getCollisionShape(), *pair.b->getCollisionShape());
    }

    /// Of any two objects.
    [[nodiscard]] bool areManifolds(int most) {
        const int count = next();
        ownedCount_ += static_cast<std::size_t>(std::max(count, 0));
        return 0 <= count && count <= most && ownedCount_ <= image_.heads_.size();
    }

    /// Whether that was all, and each manifold has a place of its own.
    [[nodiscard]] bool isAtEnd() const {
        std::vector<char> isTaken(image_.heads_.size(), 0);
        for (const Head& head : image_.heads_) {
            const auto place = static_cast<std::size_t>(head.place);
            if (place >= isTaken.size() || std::exchange(isTaken[place], 1) != 0) {
                return false;
            }
        }
        return at_ == image_.owned_.size() && ownedCount_ == isTaken.size();
    }

private:
    [[nodiscard]] bool isAlgorithm(const btCollisionShape& a, const btCollisionShape& b) {
        const int has = next();
        if (has != 1) {
            return has == 0;
        }
        const AlgorithmKind kind = kindOf(a, b);
        if (kind == AlgorithmKind::leaf) {
            return isManifoldOfPair();
        }
        const btCompoundShape& compound = compoundOf(a.isCompound() ? a : b);
        const btCollisionShape& other = a.isCompound() ? b : a;
        if (next() != compound.getNumChildShapes()) {
            return false;
        }
        for (int i = 0; i < compound.getNumChildShapes(); ++i) {
            if (!isAlgorithm(*compound.getChildShape(i), other)) {
                return false;
            }
        }
        return kind == AlgorithmKind::compound || areChildPairs(compoundOf(a), compoundOf(b));
    }

    [[nodiscard]] bool isManifoldOfPair() {
        if (!areManifolds(1)) {
            return false;
        }
        if (image_.owned_[at_ - 1] == 0) {
            return true;
        }
        const Head& head = image_.heads_[ownedCount_ - 1];
        return (head.bodies[0] == pair_.a && head.bodies[1] == pair_.b) ||
               (head.bodies[0] == pair_.b && head.bodies[1] == pair_.a);
    }
    [[nodiscard]] bool areChildPairs(const btCompoundShape& a, const btCompoundShape& b) {
        const int count = next();
        FlatSet met;
        for (int i = 0; i < count; ++i) {
            const std::array<int, 2> children{next(), next()};
            const bool areThere = children[0] >= 0 && children[0] < a.getNumChildShapes() &&
                                  children[1] >= 0 && children[1] < b.getNumChildShapes();
            const std::uint64_t key = static_cast<std::uint64_t>(children[0]) << 32 |
                                      static_cast<std::uint32_t>(children[1]);
            if (!areThere || met.contains(key) ||
                !isAlgorithm(*a.getChildShape(children[0]), *b.getChildShape(children[1]))) {
                return false;
            }
            met.findOrInsert(key);
        }
        return count >= 0;
    }
    /// -1 beyond the end.
    [[nodiscard]] int next() { return at_ < image_.owned_.size() ? image_.owned_[at_++] : -1; }

    const ContactImage& image_;
    ObjectPair pair_{};
    std::size_t ownedCount_ = 0;
    std::size_t at_ = 0;
};

void ContactImage::write(ByteWriter& to, const ObjectNumbers& numbers) const {
    to.write(static_cast<std::uint32_t>(owned_.size()));
    to.write(owned_.data(), owned_.size() * sizeof(int));
    to.write(static_cast<std::uint32_t>(heads_.size()));
    for (const Head& head : heads_) {
        to.write(numbers.of(head.bodies[0]));
        to.write(numbers.of(head.bodies[1]));
        to.write(head.breakingThreshold);
        to.write(head.processingThreshold);
        to.write(head.companions[0]);
        to.write(head.companions[1]);
        to.write(head.place);
        to.write(head.pointCount);
    }
    for (const btManifoldPoint& point : points_) {
        saveMembers(const_cast<btManifoldPoint&>(point), to);
    }
}

bool ContactImage::read(ByteReader& from, std::span<btCollisionObject* const> objects,
                        std::span<const ObjectPair> pairs) {
    begin();
    const auto ownedCount = from.read<std::uint32_t>();
    if (ownedCount > from.left() / sizeof(int)) {
        return false;
    }
    owned_.resize(ownedCount);
    from.read(owned_.data(), ownedCount * sizeof(int));
    const auto headCount = from.read<std::uint32_t>();
    constexpr std::size_t kHeadBytes = 6 * sizeof(int) + 2 * sizeof(btScalar);
    if (headCount > from.left() / kHeadBytes) {
        return false;
    }
    std::size_t pointCount = 0;
    for (std::uint32_t i = 0; i < headCount; ++i) {
        const auto a = from.read<std::uint32_t>();
        const auto b = from.read<std::uint32_t>();
        Head& head = heads_.emplace_back();
        head.breakingThreshold = from.read<btScalar>();
        head.processingThreshold = from.read<btScalar>();
        head.companions[0] = from.read<int>();
        head.companions[1] = from.read<int>();
        head.place = from.read<int>();
        head.pointCount = from.read<int>();
        if (a >= objects.size() || b >= objects.size() || head.pointCount < 0 ||
            head.pointCount > MANIFOLD_CACHE_SIZE) {
            return false;
        }
        head.bodies[0] = objects[a];
        head.bodies[1] = objects[b];
        pointCount += static_cast<std::size_t>(head.pointCount);
    }
    btManifoldPoint point(btVector3(0, 0, 0), btVector3(0, 0, 0), btVector3(0, 0, 0), 0);
    if (pointCount > from.left() / bytesOf(point)) {
        return false;
    }
    points_.reserve(pointCount);
    for (std::size_t i = 0; i < pointCount; ++i) {
        restoreMembers(point, from);
        points_.push_back(point);
    }
    Checker checker(*this);
    return std::ranges::all_of(pairs,
                               [&](const ObjectPair& pair) { return checker.isAlgorithm(pair); }) &&
           checker.areManifolds(static_cast<int>(headCount)) && checker.isAtEnd();
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
