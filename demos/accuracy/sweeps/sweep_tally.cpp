// SPDX-License-Identifier: Zlib
#include <demos/accuracy/sweeps/sweep_tally.hpp>

#include <algorithm>
#include <iterator>
#include <limits>

namespace hashphase::demos {
namespace {

std::uint64_t countIn(const std::vector<PairKey>& a, const std::vector<PairKey>& notInB) {
    std::vector<PairKey> difference;
    std::set_difference(a.begin(), a.end(), notInB.begin(), notInB.end(),
                        std::back_inserter(difference));
    return difference.size();
}

/// Pairs of one mover at least that did not touch when the frame began; sorted.
std::vector<PairKey> freshPairs(const SweepFinder& finder, std::uint32_t movers,
                                const std::vector<PairKey>& older) {
    std::vector<PairKey> listed;
    finder.listPairs(listed);
    std::erase_if(listed, [movers](PairKey pair) { return firstOf(pair) >= movers; });
    std::sort(listed.begin(), listed.end());
    std::erase_if(
        listed, [&](PairKey pair) { return std::binary_search(older.begin(), older.end(), pair); });
    return listed;
}

void askTimes(const SweepMethod& method, const SweptFrame& frame, const SweepTruth& truth,
              SweepTally& tally) {
    for (std::size_t i = 0; i < truth.contacts.size(); ++i) {
        const std::optional<double> time = method.contactTime(
            frame.objects[firstOf(truth.contacts[i])], frame.objects[secondOf(truth.contacts[i])]);
        const double error =
            time ? truth.moments[i].errorOf(*time) : std::numeric_limits<double>::infinity();
        tally.worstTimeError = std::max(tally.worstTimeError, error);
        tally.worstRelativeTimeError =
            std::max(tally.worstRelativeTimeError, error / truth.moments[i].value());
        ++tally.timesAsked;
    }
}

}  // namespace

SweepTally& SweepTally::operator+=(const SweepTally& more) {
    frames += more.frames;
    movers += more.movers;
    contacts += more.contacts;
    missed += more.missed;
    invented += more.invented;
    framesUnlike += more.framesUnlike;
    timesAsked += more.timesAsked;
    worstTimeError = std::max(worstTimeError, more.worstTimeError);
    worstRelativeTimeError = std::max(worstRelativeTimeError, more.worstRelativeTimeError);
    if (more.work) {
        work = SweepWork{(work ? work->cells : 0) + more.work->cells,
                         (work ? work->tests : 0) + more.work->tests};
    }
    return *this;
}

SweepFinders makeFinders(std::span<const SweepMethod> methods, const SweptFrame& frame) {
    SweepFinders finders;
    for (const SweepMethod& method : methods) {
        finders.push_back(method.make(frame));
    }
    return finders;
}

void judgeFrame(std::span<const SweepMethod> methods, const SweepFinders& finders,
                const SweptFrame& frame, int frameNumber, std::span<SweepTally> tallies) {
    const SweepTruth truth = findTruth(frame);
    std::optional<std::vector<PairKey>> ofFirstExact;
    for (std::size_t i = 0; i < methods.size(); ++i) {
        if (frameNumber % methods[i].oneFrameIn != 0) {
            continue;
        }
        finders[i]->step(frame);
        std::vector<PairKey> listed = freshPairs(*finders[i], frame.movers, truth.older);
        SweepTally tally;
        tally.frames = 1;
        tally.movers = frame.movers;
        tally.contacts = truth.contacts.size();
        tally.missed = countIn(truth.contacts, listed);
        tally.invented = countIn(listed, truth.contacts);
        tally.work = finders[i]->work();
        if (methods[i].contactTime) {
            askTimes(methods[i], frame, truth, tally);
        }
        if (methods[i].isExact() && methods[i].oneFrameIn == 1) {
            tally.framesUnlike = ofFirstExact && listed != *ofFirstExact ? 1 : 0;
            ofFirstExact = ofFirstExact ? ofFirstExact : std::move(listed);
        }
        tallies[i] += tally;
    }
}

}  // namespace hashphase::demos
