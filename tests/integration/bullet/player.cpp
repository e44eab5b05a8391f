// SPDX-License-Identifier: Zlib
#include <tests/integration/bullet/player.hpp>

#include <tests/integration/bullet/broadphases.hpp>

#include <algorithm>
#include <iterator>
#include <sstream>

namespace hashphase::test {
namespace {

void describe(std::ostringstream& text, const char* what, const ObjectPairs& pairs) {
    if (pairs.empty()) {
        return;
    }
    text << pairs.size() << ' ' << what << ':';
    for (std::size_t i = 0; i < std::min<std::size_t>(pairs.size(), 5); ++i) {
        text << " (" << pairs[i].first << ", " << pairs[i].second << ')';
    }
    text << "; ";
}

ObjectPairs minus(const ObjectPairs& from, const ObjectPairs& what) {
    ObjectPairs rest;
    std::set_difference(from.begin(), from.end(), what.begin(), what.end(),
                        std::back_inserter(rest));
    return rest;
}

}  // namespace

std::string difference(const ObjectPairs& pairs, const ObjectPairs& expected) {
    std::ostringstream text;
    describe(text, "missing", minus(expected, pairs));
    describe(text, "too many or twice", minus(pairs, expected));
    return text.str();
}

std::string excess(const ObjectPairs& pairs, const ObjectPairs& superset) {
    std::ostringstream text;
    describe(text, "not there", minus(pairs, superset));
    return text.str();
}

bool groupsCollide(int groupA, int maskA, int groupB, int maskB) {
    return (groupA & maskB) != 0 && (groupB & maskA) != 0;
}

void Truth::play(const Frame& frame) {
    for (const Command& command : frame) {
        Object& object = objects_[static_cast<std::size_t>(command.object)];
        switch (command.action) {
            case Action::create:
                object = {command.box, command.group, command.mask, true};
                break;
            case Action::destroy:
                object.isAlive = false;
                break;
            case Action::set:
                object.box = command.box;
                break;
            case Action::regroup:
                object.group = command.group;
                object.mask = command.mask;
                break;
            case Action::changeFilter:
                divisor_ = command.mask;
                break;
        }
    }
}

bool Truth::filterAccepts(int a, int b) const {
    return divisor_ != 0 ? (a + b) % divisor_ != 0
                         : groupsCollide(at(a).group, at(a).mask, at(b).group, at(b).mask);
}

ObjectPairs Truth::pairs() const {
    ObjectPairs pairs;
    const int count = static_cast<int>(objects_.size());
    for (int a = 0; a < count; ++a) {
        for (int b = a + 1; at(a).isAlive && b < count; ++b) {
            if (at(b).isAlive && overlap(at(a).box, at(b).box) && filterAccepts(a, b)) {
                pairs.emplace_back(a, b);
            }
        }
    }
    return pairs;
}

Player::Player(int objectCount, std::unique_ptr<btBroadphaseInterface> broadphase,
               std::unique_ptr<btOverlappingPairCache> cache)
    : cache_(std::move(cache)),
      broadphase_(std::move(broadphase)),
      filter_(std::make_unique<DivisorFilter>()),
      clients_(static_cast<std::size_t>(objectCount)),
      proxies_(static_cast<std::size_t>(objectCount)) {}

Player::~Player() {
    for (std::size_t i = 0; i < proxies_.size(); ++i) {
        if (proxies_[i] != nullptr) {
            destroyProxy(static_cast<int>(i));  // btDbvtBroadphase leaks what is left to it
        }
    }
}

void Player::play(const Frame& frame) {
    for (const Command& command : frame) {
        play(command);
    }
}

void Player::play(const Command& command) {
    switch (command.action) {
        case Action::create:
            createProxy(command);
            break;
        case Action::destroy:
            destroyProxy(command.object);
            break;
        case Action::set:
            broadphase_->setAabb(proxy(command.object), command.box.min, command.box.max, nullptr);
            break;
        case Action::regroup:
            proxy(command.object)->m_collisionFilterGroup = command.group;
            proxy(command.object)->m_collisionFilterMask = command.mask;
            askFilterAgain(*broadphase_, proxy(command.object));
            break;
        case Action::changeFilter:
            changeFilter(command.mask);
            break;
    }
}

void Player::createProxy(const Command& command) {
    const auto object = static_cast<std::size_t>(command.object);
    clients_[object] = std::make_unique<Client>(command.object);
    proxies_[object] =
        broadphase_->createProxy(command.box.min, command.box.max, BOX_SHAPE_PROXYTYPE,
                                 clients_[object].get(), command.group, command.mask, nullptr);
}

void Player::destroyProxy(int object) {
    const auto index = static_cast<std::size_t>(object);
    broadphase_->destroyProxy(proxies_[index], nullptr);
    proxies_[index] = nullptr;
    // Kept, so that whoever is told of a pair too late can be told from whoever is told in time.
    clients_[index]->isAlive = false;
    deadClients_.push_back(std::move(clients_[index]));
}

void Player::changeFilter(int divisor) {
    filter_->divisor = divisor;
    cache().setOverlapFilterCallback(divisor != 0 ? filter_.get() : nullptr);
    for (btBroadphaseProxy* const proxy : proxies_) {
        if (proxy != nullptr) {
            askFilterAgain(*broadphase_, proxy);
        }
    }
}

ObjectPairs Player::pairs() const {
    ObjectPairs pairs;
    const btBroadphasePairArray& array = cache().getOverlappingPairArray();
    for (int i = 0; i < array.size(); ++i) {
        pairs.push_back(std::minmax({objectOf(array[i].m_pProxy0), objectOf(array[i].m_pProxy1)}));
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

ObjectPairs Player::overlappingPairs() const {
    ObjectPairs overlapping = pairs();
    std::erase_if(overlapping, [&](const std::pair<int, int>& pair) {
        const btBroadphaseProxy& a = *proxy(pair.first);
        const btBroadphaseProxy& b = *proxy(pair.second);
        return !overlap({a.m_aabbMin, a.m_aabbMax}, {b.m_aabbMin, b.m_aabbMax});
    });
    return overlapping;
}

}  // namespace hashphase::test
