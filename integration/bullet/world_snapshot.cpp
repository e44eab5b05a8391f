// SPDX-License-Identifier: Zlib
#include <integration/bullet/world_snapshot.hpp>

#include <integration/bullet/detail/world_image.hpp>

#include <utility>

namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE {

struct WorldSnapshot::Image : detail::WorldImage {};

WorldSnapshot::WorldSnapshot() noexcept = default;
WorldSnapshot::~WorldSnapshot() = default;
WorldSnapshot::WorldSnapshot(WorldSnapshot&& other) noexcept = default;
WorldSnapshot& WorldSnapshot::operator=(WorldSnapshot&& other) noexcept = default;

std::string WorldSnapshot::save(btDiscreteDynamicsWorld& world,
                                const SpatialHashBroadphase& broadphase) {
    if (image_ == nullptr) {
        image_ = std::make_unique<Image>();
    }
    image_->isSaved = false;
    std::string fault = detail::WorldImage::faultOf(world, broadphase);
    if (fault.empty()) {
        fault = image_->save(world, broadphase);
    }
    if (fault.empty()) {
        image_->broadphase.save(broadphase);
        image_->isSaved = true;
    }
    return fault;
}

std::string WorldSnapshot::restore(btDiscreteDynamicsWorld& world,
                                   SpatialHashBroadphase& broadphase,
                                   const Returned& returned) const {
    if (isEmpty()) {
        return "WorldSnapshot::restore(): the snapshot is empty. Call save() or read() first.";
    }
    std::string fault = detail::WorldImage::faultOf(world, broadphase);
    if (fault.empty()) {
        fault = image_->find(world, returned);
    }
    if (fault.empty()) {
        image_->makeRoom(world, broadphase);
        image_->takeOutAdded(world);
        image_->restore(world, broadphase);
    }
    return fault;
}

std::string WorldSnapshot::write(std::vector<std::byte>& bytes) const {
    bytes.clear();
    return isEmpty() ? "WorldSnapshot::write(): the snapshot is empty. Call save() or read() first."
                     : image_->write(bytes);
}

std::string WorldSnapshot::read(std::span<const std::byte> bytes, btDiscreteDynamicsWorld& world,
                                const SpatialHashBroadphase& broadphase, const Returned& returned) {
    std::string fault = detail::WorldImage::faultOf(world, broadphase);
    auto image = std::make_unique<Image>();
    if (fault.empty()) {
        fault = image->read(bytes, world, broadphase, returned);
    }
    if (fault.empty()) {
        image_ = std::move(image);
        image_->isSaved = true;
    }
    return fault;
}

bool WorldSnapshot::isEmpty() const noexcept {
    return image_ == nullptr || !image_->isSaved;
}

std::size_t WorldSnapshot::memoryBytes() const noexcept {
    return sizeof(*this) + (image_ != nullptr ? image_->memoryBytes() : 0);
}

}  // namespace hashphase::inline HASHPHASE_BULLET_NAMESPACE
