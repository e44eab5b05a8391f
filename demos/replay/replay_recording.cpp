// SPDX-License-Identifier: Zlib
#include <demos/replay/replay_recording.hpp>

#include <demos/replay/replay_selection.hpp>
#include <demos/replay/replay_words.hpp>
#include <demos/report/base64.hpp>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr std::uint32_t kNotRecorded = ~std::uint32_t{0};

// Of a frame's counts in JSON: frame by frame a number of some digits and a comma for each.
constexpr std::size_t kBytesOfCounts = 32;

std::string littleEndian(std::span<const std::uint32_t> numbers) {
    std::vector<std::uint8_t> bytes;
    bytes.reserve(numbers.size() * 4);
    for (const std::uint32_t number : numbers) {
        for (unsigned shift = 0; shift < 32; shift += 8) {
            bytes.push_back(static_cast<std::uint8_t>(number >> shift & 255U));
        }
    }
    return base64(bytes);
}

std::size_t sumOf(const std::vector<std::size_t>& counts) {
    return std::accumulate(counts.begin(), counts.end(), std::size_t{0});
}

Json threeNumbers(const Vector3<float>& vector) {
    return {vector.x(), vector.y(), vector.z()};
}

}  // namespace

ReplayRecording::ReplayRecording(ReplaySettings settings)
    : settings_(std::move(settings)),
      isFull_(settings_.frames == 0),
      wrong_(settings_.broadphases.size()) {}

void ReplayRecording::add(std::size_t broadphase, const ReplayFrame& frame) {
    if (shared_.empty()) {
        begin(frame.boxes);
    }
    Shared& shared = shared_[settings_.sharesBoxes ? 0 : broadphase];
    if (shared.inAll.size() == frames_) {
        constexpr auto kAll = std::numeric_limits<std::size_t>::max();
        shared.boxes.add(frame.boxes, frame.exact);
        shared.pairs.add(amongRecorded(frame.exact, kAll));
        shared.inAll.push_back(frame.exact.size());
    }
    WrongPairs& wrong = wrong_[broadphase];
    wrong.missing.push_back(frame.missing.size());
    wrong.extra.push_back(frame.extra.size());
    wrong.cellSize = frame.cellSize;
    if (wrong.first.is_null()) {
        describeFirst(frame, wrong);
    }
    wrong.missingListed.push_back(list(frame.missing, wrong));
    wrong.extraListed.push_back(list(frame.extra, wrong));
}

void ReplayRecording::finishFrame() {
    if (bytes() > settings_.bytes) {
        isFull_ = true;
        removeLastFrame();
        return;
    }
    ++frames_;
    isFull_ = frames_ == settings_.frames;
}

void ReplayRecording::removeLastFrame() {
    for (Shared& shared : shared_) {
        shared.boxes.removeLast();
        shared.pairs.removeLast();
        shared.inAll.pop_back();
    }
    for (WrongPairs& wrong : wrong_) {
        const std::size_t listed = wrong.missingListed.back() + wrong.extraListed.back();
        wrong.places.resize(wrong.places.size() - 2 * listed);
        for (auto* counts :
             {&wrong.missing, &wrong.extra, &wrong.missingListed, &wrong.extraListed}) {
            counts->pop_back();
        }
        if (!wrong.first.is_null() && wrong.first["frame"] == frames_) {
            wrong.first = nullptr;
        }
    }
}

void ReplayRecording::begin(std::span<const Aabb<float>> boxes) {
    objectCount_ = boxes.size();
    ReplaySelection selection = selectForReplay(boxes, settings_.bounds, settings_.objects);
    objects_ = std::move(selection.objects);
    bounds_ = selection.bounds;
    typicalEdge_ = selection.typicalEdge;
    placeOf_.assign(boxes.size(), kNotRecorded);
    for (std::size_t place = 0; place < objects_.size(); ++place) {
        placeOf_[objects_[place]] = static_cast<std::uint32_t>(place);
    }
    shared_.assign(settings_.sharesBoxes ? 1 : wrong_.size(),
                   {ReplayTrack(bounds_, objects_), ReplayPairs(settings_.pairs)});
}

/// Places keep the order of the objects' numbers, so that sorted pairs stay sorted.
std::vector<PairKey> ReplayRecording::amongRecorded(std::span<const PairKey> pairs,
                                                    std::size_t most) const {
    std::vector<PairKey> places;
    for (const PairKey pair : pairs) {
        const std::uint32_t a = placeOf_[firstOf(pair)];
        const std::uint32_t b = placeOf_[secondOf(pair)];
        if (a != kNotRecorded && b != kNotRecorded) {
            places.push_back(pairKey(a, b));
            if (places.size() == most) {
                break;
            }
        }
    }
    return places;
}

std::size_t ReplayRecording::list(std::span<const PairKey> pairs, WrongPairs& wrong) const {
    const std::vector<PairKey> listed = amongRecorded(pairs, settings_.wrongPairs);
    for (const PairKey pair : listed) {
        wrong.places.insert(wrong.places.end(), {firstOf(pair), secondOf(pair)});
    }
    return listed.size();
}

void ReplayRecording::describeFirst(const ReplayFrame& frame, WrongPairs& wrong) const {
    for (const bool isMissing : {true, false}) {
        for (const PairKey pair : isMissing ? frame.missing : frame.extra) {
            const std::uint32_t a = placeOf_[firstOf(pair)];
            const std::uint32_t b = placeOf_[secondOf(pair)];
            if (a != kNotRecorded && b != kNotRecorded) {
                wrong.first = {{"frame", frames_},
                               {"missing", isMissing},
                               {"places", {a, b}},
                               {"words", wrongPairWords(pair, isMissing, frame.boxes[firstOf(pair)],
                                                        frame.boxes[secondOf(pair)])}};
                return;
            }
        }
    }
}

std::size_t ReplayRecording::bytes() const {
    std::size_t raw = 0;
    for (const Shared& shared : shared_) {
        raw += shared.boxes.stream().size() + shared.pairs.stream().size();
    }
    for (const WrongPairs& wrong : wrong_) {
        raw += wrong.places.size() * 4;
    }
    const std::size_t counts = (shared_.size() + wrong_.size()) * (frames_ + 1) * kBytesOfCounts;
    return raw * 4 / 3 + counts;
}

std::size_t ReplayRecording::missingCount(std::size_t broadphase) const {
    return sumOf(wrong_[broadphase].missing);
}

std::size_t ReplayRecording::extraCount(std::size_t broadphase) const {
    return sumOf(wrong_[broadphase].extra);
}

std::size_t ReplayRecording::cutCount() const {
    std::size_t count = 0;
    for (std::size_t place = 0; place < objects_.size(); ++place) {
        count += std::any_of(shared_.begin(), shared_.end(), [place](const Shared& shared) {
            return shared.boxes.isCut()[place] != 0;
        });
    }
    return count;
}

std::size_t ReplayRecording::framesWithoutPairs() const {
    std::size_t most = 0;
    for (const Shared& shared : shared_) {
        std::size_t without = 0;
        for (std::size_t frame = 0; frame < frames_; ++frame) {
            without += shared.pairs.listedCounts()[frame] < shared.pairs.counts()[frame];
        }
        most = std::max(most, without);
    }
    return most;
}

Json ReplayRecording::json() const {
    Json json{{"frames", frames_},
              {"objects", objects_.size()},
              {"objectsInAll", objectCount_},
              {"noun", settings_.noun},
              {"spheres", settings_.areSpheres},
              {"low", threeNumbers(bounds_.min())},
              {"high", threeNumbers(bounds_.max())},
              {"typicalEdge", typicalEdge_},
              {"tracks", Json::array()},
              {"broadphases", Json::array()}};
    for (const Shared& shared : shared_) {
        json["tracks"].push_back({{"pairsInAll", shared.inAll},
                                  {"pairs", shared.pairs.counts()},
                                  {"pairsListed", shared.pairs.listedCounts()},
                                  {"pairStream", base64(shared.pairs.stream())},
                                  {"boxStream", base64(shared.boxes.stream())}});
    }
    for (std::size_t i = 0; i < wrong_.size(); ++i) {
        const WrongPairs& wrong = wrong_[i];
        json["broadphases"].push_back({{"name", settings_.broadphases[i]},
                                       {"track", settings_.sharesBoxes ? 0 : i},
                                       {"missing", wrong.missing},
                                       {"extra", wrong.extra},
                                       {"missingListed", wrong.missingListed},
                                       {"extraListed", wrong.extraListed},
                                       {"places", littleEndian(wrong.places)},
                                       {"cellSize", orNull(wrong.cellSize)},
                                       {"first", wrong.first}});
    }
    return json;
}

}  // namespace hashphase::demos
