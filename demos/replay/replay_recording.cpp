// SPDX-License-Identifier: Zlib
#include <demos/replay/replay_recording.hpp>

#include <demos/report/base64.hpp>
#include <demos/report/report_text.hpp>

#include <algorithm>
#include <sstream>
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

Json threeNumbers(const Vector3<float>& vector) {
    return {vector.x(), vector.y(), vector.z()};
}

/// How far the boxes are apart along the axis that parts them most; at most 0 where they overlap.
struct Gap {
    double metres = 0;
    char axis = 'x';
};

Gap gapBetween(const Aabb<float>& a, const Aabb<float>& b) {
    const Vector3<double> gaps = (b.min().cast<double>() - a.max().cast<double>())
                                     .cwiseMax(a.min().cast<double>() - b.max().cast<double>());
    Eigen::Index axis = 0;
    const double metres = gaps.maxCoeff(&axis);
    return {metres, "xyz"[axis]};
}

std::string lengthAlong(double metres, char axis) {
    std::ostringstream text;
    text.precision(3);
    text << metres << " m along " << axis;
    return text.str();
}

/// "Objects 3 and 17 overlap by 0.25 along y, but their pair is missing: 3 is [0 0 0 to 1 1 1], ..."
std::string wrongPairWords(PairKey pair, bool isMissing, std::span<const Aabb<float>> boxes) {
    const std::string a = std::to_string(firstOf(pair));
    const std::string b = std::to_string(secondOf(pair));
    const Aabb<float>& first = boxes[firstOf(pair)];
    const Aabb<float>& second = boxes[secondOf(pair)];
    const Gap gap = gapBetween(first, second);
    std::string words = "Objects " + a + " and " + b;
    if (gap.metres > 0) {
        words += " are " + lengthAlong(gap.metres, gap.axis) + " apart";
    } else {
        words += " overlap by " + lengthAlong(-gap.metres, gap.axis);
    }
    if (isMissing) {
        words += ", but their pair is missing";
    } else if (gap.metres > 0) {
        words += ", but their pair is listed";
    } else {
        words += ", but their pair is listed twice, or against their filters";
    }
    return words + ": " + a + " is " + boxText(first) + ", " + b + " is " + boxText(second) + ".";
}

}  // namespace

ReplayRecording::ReplayRecording(ReplaySettings settings)
    : settings_(std::move(settings)),
      isFull_(settings_.frames == 0),
      wrong_(settings_.broadphases.size()) {}

void ReplayRecording::add(std::size_t broadphase, const ReplayFrame& frame) {
    if (tracks_.empty()) {
        begin(frame.boxes);
    }
    ReplayTrack& track = tracks_[settings_.sharesBoxes ? 0 : broadphase];
    if (track.pairsInAll.size() == frames_) {
        track.add(frame.boxes, frame.exact, amongRecorded(frame.exact));
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
    for (ReplayTrack& track : tracks_) {
        track.removeLast();
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
    selection_ = selectForReplay(boxes, settings_.bounds, settings_.objects);
    const std::vector<std::uint32_t>& objects = selection_.objects;
    placeOf_.assign(boxes.size(), kNotRecorded);
    for (std::size_t place = 0; place < objects.size(); ++place) {
        placeOf_[objects[place]] = static_cast<std::uint32_t>(place);
    }
    ground_ = sampleGround(settings_.ground, selection_.bounds);
    tracks_.assign(settings_.sharesBoxes ? 1 : wrong_.size(),
                   ReplayTrack(selection_.bounds, objects, settings_.pairs));
}

std::optional<PairKey> ReplayRecording::placesOf(PairKey pair) const {
    const std::uint32_t a = placeOf_[firstOf(pair)];
    const std::uint32_t b = placeOf_[secondOf(pair)];
    return a != kNotRecorded && b != kNotRecorded ? std::optional(pairKey(a, b)) : std::nullopt;
}

/// Places keep the order of the objects' numbers, so that sorted pairs stay sorted.
std::vector<PairKey> ReplayRecording::amongRecorded(std::span<const PairKey> pairs,
                                                    std::size_t most) const {
    std::vector<PairKey> places;
    for (const PairKey pair : pairs) {
        if (places.size() == most) {
            break;
        }
        if (const std::optional<PairKey> place = placesOf(pair)) {
            places.push_back(*place);
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
            if (const std::optional<PairKey> places = placesOf(pair)) {
                wrong.first = {{"frame", frames_},
                               {"missing", isMissing},
                               {"places", {firstOf(*places), secondOf(*places)}},
                               {"words", wrongPairWords(pair, isMissing, frame.boxes)}};
                return;
            }
        }
    }
}

std::size_t ReplayRecording::bytes() const {
    std::size_t raw = ground_.heights.size();
    for (const ReplayTrack& track : tracks_) {
        raw += track.boxStream.size() + track.pairStream.size();
    }
    for (const WrongPairs& wrong : wrong_) {
        raw += wrong.places.size() * 4;
    }
    const std::size_t counts = (tracks_.size() + wrong_.size()) * (frames_ + 1) * kBytesOfCounts;
    return raw * 4 / 3 + counts;
}

Json ReplayRecording::json() const {
    std::size_t cutCount = 0;
    for (std::size_t place = 0; place < selection_.objects.size(); ++place) {
        cutCount += std::ranges::any_of(
            tracks_, [place](const ReplayTrack& track) { return track.isCut[place] != 0; });
    }
    Json json{{"frames", frames_},
              {"objects", selection_.objects.size()},
              {"objectsInAll", placeOf_.size()},
              {"objectsCut", cutCount},
              {"noun", settings_.noun},
              {"spheres", settings_.areSpheres},
              {"low", threeNumbers(selection_.bounds.min())},
              {"high", threeNumbers(selection_.bounds.max())},
              {"typicalEdge", selection_.typicalEdge},
              {"ground", groundJson(ground_)},
              {"opensOn", settings_.opensOn},
              {"tracks", Json::array()},
              {"broadphases", Json::array()}};
    for (const ReplayTrack& track : tracks_) {
        json["tracks"].push_back({{"pairsInAll", track.pairsInAll},
                                  {"pairs", track.pairCounts},
                                  {"pairsListed", track.pairsListed},
                                  {"pairStream", base64(track.pairStream)},
                                  {"boxStream", base64(track.boxStream)}});
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
