// SPDX-License-Identifier: Zlib
#include <integration/effects/scene_effects.hpp>

#include <broadphase/radius_search.hpp>
#include <integration/ai/radar.hpp>

#include <array>
#include <sstream>

namespace hashphase {
namespace {

/// Calls visit(effect, optional) for every member of the declaration.
template <class Declaration, class Visit>
void forEachMember(Declaration& effects, const Visit& visit) {
    visit(Effect::motion, effects.motion);
    visit(Effect::terrain, effects.terrain);
    visit(Effect::pairs, effects.pairs);
    visit(Effect::response, effects.response);
    visit(Effect::sweep, effects.sweep);
    visit(Effect::sleeping, effects.sleeping);
    visit(Effect::rotation, effects.rotation);
    visit(Effect::friction, effects.friction);
    visit(Effect::picking, effects.picking);
    visit(Effect::boxSelection, effects.boxSelection);
    visit(Effect::culling, effects.culling);
    visit(Effect::proximity, effects.proximity);
    visit(Effect::zones, effects.zones);
    visit(Effect::radar, effects.radar);
}

struct Need {
    Effect effect;
    Effect needed;
    std::string_view why;
};

constexpr std::array kNeeds{
    Need{Effect::terrain, Effect::motion, "it puts moved bodies on the ground"},
    Need{Effect::response, Effect::pairs, "it acts on pairs"},
    Need{Effect::response, Effect::motion, "it changes the velocities of bodies"},
    Need{Effect::sweep, Effect::pairs, "it finds pairs on the paths of fast bodies"},
    Need{Effect::sweep, Effect::motion, "it follows moving bodies"},
    Need{Effect::sleeping, Effect::motion, "it stops moving bodies"},
    Need{Effect::rotation, Effect::motion, "it turns moving bodies"},
    Need{Effect::friction, Effect::response, "it acts between bodies that bounce off each other"},
};

std::string missingNeed(EffectSet declared) {
    for (const Need& need : kNeeds) {
        if (declared.contains(need.effect) && !declared.contains(need.needed)) {
            std::ostringstream sentence;
            sentence << nameOf(need.effect) << " is declared without " << nameOf(need.needed)
                     << ", but " << need.why << ". Declare " << nameOf(need.needed)
                     << " too, or leave out " << nameOf(need.effect) << '.';
            return sentence.str();
        }
    }
    return {};
}

/// Gathers the first setting that is wrong.
class Settings {
public:
    template <class Number>
    void require(bool isRight, std::string_view field, Number value, std::string_view valid) {
        if (!isRight && error_.empty()) {
            std::ostringstream sentence;
            sentence << field << " is " << value << ", but must be " << valid << '.';
            error_ = sentence.str();
        }
    }
    void requireNotNegative(std::string_view field, double value, std::string_view unit) {
        require(value >= 0, field, value, "0 or more " + std::string(unit));
    }
    void requireFrames(std::string_view field, std::uint32_t frames) {
        require(frames >= 1 && frames <= kMostEffectFrames, field, frames, "from 1 to 1000000");
    }
    void requireSomeFar(const std::string& effect, double interestRadius, std::uint32_t frames) {
        requireNotNegative(effect + ".interestRadius", interestRadius, "[m]");
        requireFrames(effect + ".farFrames", frames);
        if (error_.empty() && frames > 1 && !(interestRadius < kInfinity)) {
            std::ostringstream sentence;
            sentence << effect << ".farFrames is " << frames
                     << ", but no distance counts as far. Set " << effect
                     << ".interestRadius too [m].";
            error_ = sentence.str();
        }
    }
    [[nodiscard]] const std::string& error() const noexcept { return error_; }

    static constexpr double kInfinity = std::numeric_limits<double>::infinity();

private:
    std::string error_;
};

// Each test is phrased so that NaN fails it.
void requireBounds(const Aabb<double>& bounds, Settings& settings) {
    for (int axis = 0; axis < 3; ++axis) {
        const double low = bounds.min()[axis];
        const double high = bounds.max()[axis];
        settings.require(low <= high, "motion.bounds: the lower corner", low,
                         "not above the upper one [m]");
        settings.require(low <= kMostEffectLength, "motion.bounds: the lower corner", low,
                         "at most 1e30 [m]");
        settings.require(high >= -kMostEffectLength, "motion.bounds: the upper corner", high,
                         "at least -1e30 [m]");
    }
}

void requireOfMovers(const SceneEffects& effects, Settings& settings) {
    if (effects.motion) {
        requireBounds(effects.motion->bounds, settings);
    }
    if (effects.response) {
        const double restitution = effects.response->restitution;
        settings.require(restitution >= 0 && restitution <= 1, "response.restitution", restitution,
                         "between 0 and 1");
    }
    if (effects.sweep) {
        settings.require(effects.sweep->mode != Sweep::none, "sweep.mode", "none",
                         "automatic, box or line. To sweep nothing, leave out sweep");
        settings.requireNotNegative("sweep.fastFrom", effects.sweep->fastFrom, "diameters a frame");
    }
    if (effects.sleeping) {
        const SleepingEffect& sleeping = *effects.sleeping;
        settings.requireNotNegative("sleeping.interestRadius", sleeping.interestRadius, "[m]");
        settings.requireNotNegative("sleeping.slowBelow", sleeping.slowBelow, "[m/s]");
        settings.requireFrames("sleeping.framesBeforeSleep", sleeping.framesBeforeSleep);
    }
}

void requireOfAgents(const ProximityEffect& proximity, Settings& settings) {
    constexpr std::uint32_t most = RadiusSearch<float>::kMostGroups;
    settings.requireNotNegative("proximity.radius", proximity.radius, "[m]");
    settings.require(proximity.colourCount >= 1 && proximity.colourCount <= most,
                     "proximity.colourCount", proximity.colourCount,
                     "from 1 to " + std::to_string(most));
    settings.requireSomeFar("proximity", proximity.interestRadius, proximity.farFrames);
    settings.requireFrames("proximity.turns", proximity.turns);
}

void requireOfRadar(const RadarEffect& radar, Settings& settings) {
    settings.require(radar.cellSize >= kLeastEffectLength && radar.cellSize <= kMostEffectLength,
                     "radar.cellSize", radar.cellSize, "from 1e-30 to 1e30 [m]");
    const double counts = double{1} * radar.columns * radar.rows * radar.groupCount;
    settings.require(counts >= 1 && counts <= static_cast<double>(Radar<float>::kMostCounts),
                     "radar: columns * rows * groupCount", counts,
                     "from 1 to " + std::to_string(Radar<float>::kMostCounts));
    settings.requireFrames("radar.frames", radar.frames);
}

void requireOfLookers(const SceneEffects& effects, Settings& settings) {
    if (effects.culling) {
        const CullingEffect& culling = *effects.culling;
        settings.require(culling.margin >= 0 && culling.margin <= kMostEffectLength,
                         "culling.margin", culling.margin, "from 0 to 1e30 [m]");
        settings.requireFrames("culling.restingCameraFrames", culling.restingCameraFrames);
    }
    if (effects.proximity) {
        requireOfAgents(*effects.proximity, settings);
    }
    if (effects.zones) {
        settings.requireSomeFar("zones", effects.zones->interestRadius, effects.zones->farFrames);
    }
    if (effects.radar) {
        requireOfRadar(*effects.radar, settings);
    }
}

}  // namespace

EffectSet SceneEffects::set() const noexcept {
    EffectSet declared;
    forEachMember(*this, [&](Effect effect, const auto& member) {
        if (member) {
            declared.insert(effect);
        }
    });
    return declared;
}

void SceneEffects::declare(Effect effect) {
    forEachMember(*this, [&](Effect each, auto& member) {
        if (each == effect && !member) {
            member.emplace();
        }
    });
}

void SceneEffects::remove(Effect effect) {
    forEachMember(*this, [&](Effect each, auto& member) {
        if (each == effect) {
            member.reset();
        }
    });
}

EffectSet needsOf(Effect effect) noexcept {
    EffectSet needs;
    for (const Need& need : kNeeds) {
        if (need.effect == effect) {
            needs.insert(need.needed);
            needs = needs | needsOf(need.needed);
        }
    }
    return needs;
}

std::string effectsError(const SceneEffects& effects) {
    if (std::string error = missingNeed(effects.set()); !error.empty()) {
        return error;
    }
    Settings settings;
    requireOfMovers(effects, settings);
    requireOfLookers(effects, settings);
    return settings.error().empty() ? configError(effects.grid) : settings.error();
}

}  // namespace hashphase
