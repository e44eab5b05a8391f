// SPDX-License-Identifier: Zlib
#include <integration/distributed/questions.hpp>

#include <integration/distributed/detail/parcels.hpp>

// A parcel of questions has the head of detail/parcels.hpp, then for each its number, shape, `most`, and the shape's
// numbers. A parcel of answers: the same head, then for each the question's number, how many are found, and these.

#include <broadphase/collectors.hpp>
#include <broadphase/core/limits.hpp>
#include <broadphase/diagnostics.hpp>
#include <broadphase/regions.hpp>

#include <algorithm>

namespace hashphase {
namespace {

constexpr std::uint32_t kQuestionMagic = 0x68707131;  // "hpq1"
constexpr std::uint32_t kAnswerMagic = 0x68706131;    // "hpa1"
[[maybe_unused]] constexpr const char* kAskedWhen =
    "RankQuestions: the grid has changed after its last finish(). Call pack() and answer() after "
    "finish(), before the next change.";

template <class Scalar>
void writePoint(detail::ByteWriter& writer, const Vector3<Scalar>& point) {
    writer.write(point.data(), 3 * sizeof(Scalar));
}

template <class Scalar>
Vector3<Scalar> readPoint(detail::ByteReader& reader) {
    Vector3<Scalar> point;
    reader.read(point.data(), 3 * sizeof(Scalar));
    return point;
}

template <class Scalar>
void writeQuestion(detail::ByteWriter& writer, const Question<Scalar>& question) {
    using Shape = typename Question<Scalar>::Shape;
    writer.write(question.shape);
    writer.write(question.most);
    if (question.shape != Shape::sphere) {
        writePoint<Scalar>(writer, question.extent.min());
        writePoint<Scalar>(writer, question.extent.max());
    }
    if (question.shape != Shape::box) {
        writePoint(writer, question.from);
    }
    if (question.shape == Shape::sphere) {
        writer.write(question.radius);
    }
    if (question.shape == Shape::ray) {
        writePoint(writer, question.to);
    }
}

template <class Scalar>
Question<Scalar> readQuestion(detail::ByteReader& reader) {
    using Shape = typename Question<Scalar>::Shape;
    Question<Scalar> question;
    question.shape = reader.read<Shape>();
    question.most = reader.read<std::uint32_t>();
    if (question.shape != Shape::sphere) {
        question.extent.min() = readPoint<Scalar>(reader);
        question.extent.max() = readPoint<Scalar>(reader);
    }
    if (question.shape != Shape::box) {
        question.from = readPoint<Scalar>(reader);
    }
    if (question.shape == Shape::sphere) {
        question.radius = reader.read<Scalar>();
    }
    if (question.shape == Shape::ray) {
        question.to = readPoint<Scalar>(reader);
    }
    return question;
}

/// Keeps all that is found, or with `most` those with the smallest keys; of equal keys those with the smallest
/// ids of objects, which are the same on all ranks.
template <class Scalar>
class CollectObjects {
public:
    CollectObjects(const RankGrid<Scalar>& grid, std::size_t most,
                   std::vector<FoundObject<Scalar>>& found)
        : grid_(grid), most_(most), found_(found) {
        found_.clear();
    }

    void add(ProxyId id, Scalar key) {
        const FoundObject<Scalar> object{key, grid_.globalId(id), grid_.homeOf(id)};
        if (found_.size() < most_) {
            found_.push_back(object);
            if (found_.size() == most_) {
                std::make_heap(found_.begin(), found_.end());
            }
        } else if (most_ > 0 && object < found_.front()) {
            std::pop_heap(found_.begin(), found_.end());
            found_.back() = object;
            std::push_heap(found_.begin(), found_.end());
        }
    }
    [[nodiscard]] Scalar limit() const noexcept {
        if (most_ == 0) {
            return -1;
        }
        return found_.size() < most_ ? std::numeric_limits<Scalar>::infinity() : found_.front().key;
    }

private:
    const RankGrid<Scalar>& grid_;
    std::size_t most_;
    std::vector<FoundObject<Scalar>>& found_;  // a heap once it is full, the farthest on top
};

template <class Scalar>
void findObjects(const RankGrid<Scalar>& grid, const Question<Scalar>& question,
                 std::vector<FoundObject<Scalar>>& found) {
    CollectObjects<Scalar> objects(grid, question.most, found);
    switch (question.shape) {
        case Question<Scalar>::Shape::box:
            grid.grid().visit(BoxRegion<Scalar>{question.extent}, objects);
            break;
        case Question<Scalar>::Shape::sphere:
            grid.grid().visit(SphereRegion<Scalar>(question.from, question.radius), objects);
            break;
        case Question<Scalar>::Shape::ray:
            grid.grid().visit(RayRegion<Scalar>(question.from, question.to, question.extent),
                              objects);
            break;
    }
}

/// Calls visit(rank) for each rank that may have something in the region: it has all that touches its own.
template <class Scalar, class Visit>
void forEachRankAsked(const Partition<Scalar>& partition, const Question<Scalar>& question,
                      const Visit& visit) {
    switch (question.shape) {
        case Question<Scalar>::Shape::box:
            partition.forEachRank(question.extent, visit);
            break;
        case Question<Scalar>::Shape::sphere:
            partition.forEachRank(SphereRegion<Scalar>(question.from, question.radius).bounds(),
                                  visit);
            break;
        case Question<Scalar>::Shape::ray:
            partition.forEachRankWithKey(
                RayRegion<Scalar>(question.from, question.to, question.extent), visit);
            break;
    }
}

}  // namespace

template <class Scalar>
detail::ByteWriter& RankQuestions<Scalar>::writerFor(std::uint32_t rank, std::uint32_t rankCount,
                                                     std::uint32_t magic) {
    writers_.resize(std::max<std::size_t>(writers_.size(), rankCount));
    detail::ByteWriter& writer = writers_[rank];
    if (writer.bytes().empty()) {
        destinations_.push_back(rank);
        detail::beginParcel(writer, magic);
    }
    return writer;
}

template <class Scalar>
void RankQuestions<Scalar>::clearWriters() {
    for (const std::uint32_t rank : destinations_) {
        writers_[rank].clear();
    }
    destinations_.clear();
}

template <class Scalar>
std::span<const Parcel> RankQuestions<Scalar>::pack(const RankGrid<Scalar>& grid,
                                                    std::span<const Question<Scalar>> questions) {
    HASHPHASE_ASSERT(grid.isUpToDate(), kAskedWhen);
    detail::checkCount(
        questions.size(), ~std::uint32_t{0},
        "RankQuestions::pack(): more than 4,294,967,295 questions. Pass fewer at a time.");
    clearWriters();
    numbered_.clear();
    mosts_.clear();
    const Partition<Scalar>& partition = grid.partition();
    for (std::uint32_t i = 0; i < questions.size(); ++i) {
        mosts_.push_back(questions[i].most);
        forEachRankAsked(partition, questions[i], [&](std::uint32_t rank) {
            if (rank != grid.rank()) {
                detail::ByteWriter& writer = writerFor(rank, partition.rankCount(), kQuestionMagic);
                writer.write(i);
                writeQuestion(writer, questions[i]);
                return;
            }
            findObjects(grid, questions[i], answer_);
            for (const FoundObject<Scalar>& found : answer_) {
                numbered_.push_back({i, found});
            }
        });
    }
    return sealParcels();
}

template <class Scalar>
std::span<const Parcel> RankQuestions<Scalar>::sealParcels() {
    parcels_.clear();
    for (const std::uint32_t rank : destinations_) {
        detail::sealParcel(writers_[rank]);
        parcels_.push_back({rank, writers_[rank].bytes()});
    }
    return parcels_;
}

template <class Scalar>
std::span<const Parcel> RankQuestions<Scalar>::answer(const RankGrid<Scalar>& grid,
                                                      std::span<const Parcel> received) {
    HASHPHASE_ASSERT(grid.isUpToDate(), kAskedWhen);
    clearWriters();
    for (const Parcel& parcel : received) {
        detail::ByteReader reader =
            detail::openParcel(parcel, kQuestionMagic,
                               "is not from RankQuestions::pack() of this version. Use the same "
                               "hashphase on all ranks.");
        if (parcel.rank >= grid.partition().rankCount()) {
            detail::raiseBadParcel(
                parcel,
                "is from a rank outside the partition. Set Parcel::rank to the rank that sent it.");
        }
        detail::ByteWriter& writer =
            writerFor(parcel.rank, grid.partition().rankCount(), kAnswerMagic);
        while (reader.left() > 0) {
            const auto number = reader.read<std::uint32_t>();
            const auto question = readQuestion<Scalar>(reader);
            if (reader.isTorn() || question.shape > Question<Scalar>::Shape::ray) {
                detail::raiseBadParcel(parcel,
                                       "ends within a question, or has an unknown one. Pass all "
                                       "bytes that pack() made.");
            }
            findObjects(grid, question, answer_);
            writer.write(number);
            writer.write(static_cast<std::uint32_t>(answer_.size()));
            for (const FoundObject<Scalar>& found : answer_) {
                writer.write(found.key);
                writer.write(found.object.value);
                writer.write(found.home);
            }
        }
    }
    return sealParcels();
}

template <class Scalar>
Answers<Scalar> RankQuestions<Scalar>::finish(std::span<const Parcel> received) {
    for (const Parcel& parcel : received) {
        detail::ByteReader reader =
            detail::openParcel(parcel, kAnswerMagic,
                               "is not from RankQuestions::answer() of this version. Use the same "
                               "hashphase on all ranks.");
        while (reader.left() > 0) {
            const auto number = reader.read<std::uint32_t>();
            const auto count = reader.read<std::uint32_t>();
            constexpr std::size_t kFoundBytes = sizeof(Scalar) + 8 + 4;
            if (reader.isTorn() || count > reader.left() / kFoundBytes || number >= mosts_.size()) {
                detail::raiseBadParcel(
                    parcel,
                    "ends within an answer, or answers a question that was not asked. Pass all "
                    "bytes that answer() made for the last pack().");
            }
            for (std::uint32_t i = 0; i < count; ++i) {
                FoundObject<Scalar> found;
                found.key = reader.read<Scalar>();
                found.object.value = reader.read<std::uint64_t>();
                found.home = reader.read<std::uint32_t>();
                numbered_.push_back({number, found});
            }
        }
    }
    // An object that touches several regions is found by all their ranks, with the same key.
    std::sort(numbered_.begin(), numbered_.end());
    numbered_.erase(std::unique(numbered_.begin(), numbered_.end()), numbered_.end());
    found_.clear();
    begins_.assign(1, 0);
    auto next = numbered_.begin();
    for (std::uint32_t i = 0; i < mosts_.size(); ++i) {
        for (; next != numbered_.end() && next->question == i; ++next) {
            if (found_.size() - begins_.back() < mosts_[i]) {
                found_.push_back(next->found);
            }
        }
        begins_.push_back(found_.size());
    }
    return {found_, begins_};
}

template class HASHPHASE_INSTANCE_EXPORT RankQuestions<float>;
template class HASHPHASE_INSTANCE_EXPORT RankQuestions<double>;

}  // namespace hashphase
