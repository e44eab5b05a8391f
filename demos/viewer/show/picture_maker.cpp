// SPDX-License-Identifier: Zlib
#include <demos/viewer/show/picture_maker.hpp>

#include <demos/console/format.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace hashphase::demos {
namespace {

constexpr std::size_t kMostLinks = 20'000;
constexpr float kManyPairs = 8;  // of a body: as bright as any
// Of bodies over the map of loads, which they would hide:
constexpr float kDotShare = 0.2F;   // radius, by the body's
constexpr float kDotRadius = 0.7F;  // at least, where larger ones were asked for [pixels]

/// The ramp from nothing to `most`, in even steps; the last stands for more, too, where it `isOpen`.
Legend rampOf(std::string title, double most, int digits, bool isOpen = false) {
    constexpr int kSteps = 4;
    Legend legend{std::move(title), {}};
    for (int i = 0; i <= kSteps; ++i) {
        const std::string number = fixed(most * i / kSteps, digits);
        legend.entries.push_back({sequentialColour(static_cast<float>(i) / kSteps),
                                  i == kSteps && isOpen ? number + " or more" : number});
    }
    return legend;
}

// The corners of what a camera sees: bit 0 of their number is right, bit 1 up, bit 2 far.
std::array<Vector3<float>, 8> frustumCorners(const CameraPose& pose) {
    const Eigen::Matrix4d inverse = cameraView(pose).viewProjection.cast<double>().inverse();
    std::array<Vector3<float>, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Eigen::Vector4d device((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1,
                                     (i & 4) != 0 ? 1 : 0, 1);
        const Eigen::Vector4d corner = inverse * device;
        corners[i] = (corner.head<3>() / corner.w()).cast<float>();
    }
    return corners;
}

// Edges between corners whose numbers differ in one bit.
template <class Corners>
void addEdges(const Corners& corners, Colour colour, bool isOnTop, std::vector<DrawnLine>& lines) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
        for (const std::size_t bit : {1U, 2U, 4U}) {
            if ((i & bit) == 0) {
                lines.push_back({corners[i], corners[i | bit], colour, isOnTop});
            }
        }
    }
}

}  // namespace

// --- Colours -------------------------------------------------------------------------------------

void BodyColours::prepare(const Session& session) {
    palette_ = palette(session.options.theme);
    const std::uint32_t limit = session.stage->indexLimit();
    if (session.options.colouring == Colouring::pairs) {
        pairCounts_.assign(limit, 0);
        for (const PairKey pair : session.pairs) {
            if (secondOf(pair) < limit) {
                ++pairCounts_[firstOf(pair)];
                ++pairCounts_[secondOf(pair)];
            }
        }
    }
    if (session.options.colouring == Colouring::speed) {
        float fastest = 1;
        for (std::uint32_t index = 0; index < limit; ++index) {
            if (session.isVisible(index)) {
                fastest = std::max(fastest, session.stage->body(index).speed);
            }
        }
        fastest_ = std::max(fastest, 0.98F * fastest_);  // or colours would flicker
    }
}

Colour BodyColours::of(const Session& session, std::uint32_t index, const StageBody& body) const {
    if (session.card && session.card->index == index) {
        return palette_.picked;
    }
    if (std::ranges::binary_search(session.selected, index)) {
        return palette_.selected;
    }
    return std::ranges::binary_search(session.recoloured, index)
               ? palette_.accent
               : byColouring(session, index, body);
}

Colour BodyColours::byColouring(const Session& session, std::uint32_t index,
                                const StageBody& body) const {
    const auto& kinds = qualitativeColours(session.options.theme);
    switch (session.options.colouring) {
        case Colouring::agents: {
            if (!session.stage->effects().proximity) {
                return body.isStatic ? palette_.fixed : kinds[index % kinds.size()];
            }
            const auto colours = session.stage->observers().colours();
            return kinds[index < colours.size() ? colours[index] % kinds.size() : 0];
        }
        case Colouring::cells: {
            const Grid<float>* grid = session.stage->grid();
            if (grid == nullptr) {
                return palette_.calm;
            }
            const auto cell = grid->cellAt(body.centre);
            // Neighbouring cells differ, as on a map.
            const auto kind = static_cast<std::uint64_t>(cell[0] + 3 * cell[2] + 5 * cell[1]);
            return kinds[kind % kinds.size()];
        }
        case Colouring::load: {
            const auto load =
                static_cast<float>(session.loads.at(body.centre.x(), body.centre.z()));
            return sequentialColour(load / static_cast<float>(session.loads.full));
        }
        case Colouring::speed:
            return sequentialColour(body.speed / fastest_);
        case Colouring::pairs:
            return sequentialColour(
                static_cast<float>(index < pairCounts_.size() ? pairCounts_[index] : 0) /
                kManyPairs);
        case Colouring::rest:
            return body.isStatic ? palette_.fixed : body.isAsleep ? palette_.calm : palette_.awake;
    }
    return palette_.calm;
}

std::vector<Legend> BodyColours::legends(const Session& session) const {
    std::vector<Legend> legends;
    const ViewOptions& options = session.options;
    const auto tells = [&](Colouring colouring) {
        return options.has(Overlay::bodies) && options.colouring == colouring;
    };
    if (options.has(Overlay::heat) || tells(Colouring::load)) {
        legends.push_back(rampOf("bodies in a column of cells", session.loads.full, 0));
    }
    if (tells(Colouring::speed)) {
        legends.push_back(rampOf("speed [m/s]", fastest_, 1));
    }
    if (tells(Colouring::pairs)) {
        legends.push_back(rampOf("pairs per body", kManyPairs, 0, true));
    }
    if (tells(Colouring::rest)) {
        legends.push_back(
            {"motion",
             {{palette_.fixed, "static"}, {palette_.calm, "asleep"}, {palette_.awake, "awake"}}});
    }
    return legends;
}

// --- A picture -----------------------------------------------------------------------------------

const Picture& PictureMaker::make(const Session& session, float contactFrom, int coveredLeft) {
    const ViewOptions& options = session.options;
    palette_ = palette(options.theme);
    colours_.prepare(session);
    spheres_.clear();
    boxes_.clear();
    capsules_.clear();
    lines_.clear();
    setGround(session);
    const bool areDots = picture_.heatMap && !picture_.ground.corners.empty();
    for (std::uint32_t index = 0;
         options.has(Overlay::bodies) && index < session.stage->indexLimit(); ++index) {
        if (session.isVisible(index)) {
            const StageBody body = session.stage->body(index);
            const Colour colour = colours_.of(session, index, body);
            if (areDots) {
                addDot(body, colour);
            } else {
                addBody(body, colour);
            }
        }
    }
    if (session.frozen) {
        addEdges(frustumCorners(*session.frozen), palette_.line, true, lines_);
    }
    addZones(session);
    addPairs(session);
    addMarks(session);

    picture_.camera = {cameraView(session.pose()).viewProjection, session.pose().eye};
    picture_.theme = options.theme;
    picture_.spheres = spheres_;
    picture_.boxes = boxes_;
    picture_.capsules = capsules_;
    picture_.lines = lines_;
    picture_.rectangle = session.rectangle;
    picture_.leastRadius = areDots ? std::min(options.dots, kDotRadius) : options.dots;
    picture_.contactFrom = contactFrom;
    picture_.coveredLeft = coveredLeft;
    return picture_;
}

void PictureMaker::setGround(const Session& session) {
    const std::span<const Vector3<float>> ground = session.stage->ground();
    picture_.ground = {ground, 2 * session.sceneCount + (ground.empty() ? 0 : 1)};
    picture_.gridLines.reset();
    picture_.heatMap.reset();
    const Grid<float>* grid = session.stage->grid();
    if (session.options.has(Overlay::grid) && grid != nullptr) {
        picture_.gridLines = GroundCells{Eigen::Vector2f::Zero(), grid->cellSize()};
    }
    const CellLoads& loads = session.loads;
    if (session.options.has(Overlay::heat) && !loads.isEmpty()) {
        picture_.heatMap =
            HeatMap{{loads.corner, loads.cellSize}, loads.columns, loads.rows, loads.shades};
    }
}

void PictureMaker::addDot(const StageBody& body, Colour colour) {
    if (body.shape != StageBody::Shape::none) {
        spheres_.push_back({body.centre, kDotShare * body.size.x(), colour});
    }
}

void PictureMaker::addBody(const StageBody& body, Colour colour) {
    switch (body.shape) {
        case StageBody::Shape::none:
            break;
        case StageBody::Shape::sphere:
            spheres_.push_back({body.centre, body.size.x(), colour});
            break;
        case StageBody::Shape::box:
            boxes_.push_back({body.centre, body.size, body.orientation.coeffs(), colour});
            break;
        case StageBody::Shape::capsule: {
            const Vector3<float> half = body.orientation * Vector3<float>(0, body.size.y(), 0);
            capsules_.push_back({body.centre - half, body.centre + half, body.size.x(), colour});
            break;
        }
    }
}

// --- Lines ---------------------------------------------------------------------------------------

// Around `centre`, through what `right` and `up` lead to.
void PictureMaker::addCircle(const Vector3<float>& centre, const Vector3<float>& right,
                             const Vector3<float>& up, Colour colour) {
    constexpr int kSides = 32;
    Vector3<float> before = centre + right;
    for (int i = 1; i <= kSides; ++i) {
        const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kSides;
        const Vector3<float> place = centre + std::cos(angle) * right + std::sin(angle) * up;
        lines_.push_back({before, place, colour, true});
        before = place;
    }
}

// Balls, as their circles across the axes.
void PictureMaker::addZones(const Session& session) {
    for (const InterestZone& zone : session.stage->interestZones()) {
        for (int axis = 0; axis < 3; ++axis) {
            addCircle(zone.centre, zone.radius * Vector3<float>::Unit((axis + 1) % 3),
                      zone.radius * Vector3<float>::Unit((axis + 2) % 3), palette_.accent);
        }
    }
}

// Two rings around its box, dark and light, so that one is seen on whatever is behind them, and large enough
// to be found. They are just behind the near plane, where hardly anything hides them, but no nearer than their
// coordinates can tell apart.
void PictureMaker::addRings(const StageBody& body, const CameraPose& pose) {
    const Vector3<float> fromEye = body.centre - pose.eye;
    const float distance = fromEye.norm();
    const float radius = boxAround(body).diagonal().norm() / 2;
    const float depth = cameraView(pose).viewProjection.row(3).dot(body.centre.homogeneous());
    if (!(distance > radius) || !(depth > 0)) {
        return;
    }
    constexpr float kLeast = 0.016F;  // tangents, seen from the eye
    constexpr float kApart = 0.0022F;
    const float nearest = std::max(2 * kNearPlane * distance / depth, 1e-3F * pose.eye.norm());
    const float away = std::min(nearest, distance);
    const Vector3<float> axis = fromEye / distance;
    const Vector3<float> right = axis.unitOrthogonal();
    const Vector3<float> up = right.cross(axis);
    const float inner = std::max(radius / std::sqrt(distance * distance - radius * radius), kLeast);
    for (const auto& [tangent, colour] :
         {std::pair{inner, palette_.accent}, std::pair{inner + kApart, palette_.contrast}}) {
        addCircle(pose.eye + away * axis, away * tangent * right, away * tangent * up, colour);
    }
}

// Wrong pairs first: these must be seen.
void PictureMaker::addPairs(const Session& session) {
    const auto addLink = [&](PairKey pair, Colour colour) {
        const std::array ends{firstOf(pair), secondOf(pair)};
        const bool isSeen = std::ranges::all_of(ends, [&](std::uint32_t index) {
            return session.isVisible(index) && session.stage->contains(index);
        });
        if (isSeen && lines_.size() < kMostLinks) {
            lines_.push_back({session.stage->body(ends[0]).centre,
                              session.stage->body(ends[1]).centre, colour, true});
        }
    };
    if (const PairCheck* check = session.check()) {
        for (const PairKey pair : check->missing) {
            addLink(pair, palette_.alert);
        }
        for (const PairKey pair : check->extra) {
            addLink(pair, palette_.warning);
        }
    }
    for (const PairKey pair : session.pairs) {
        const bool isOfPicked = session.card && (firstOf(pair) == session.card->index ||
                                                 secondOf(pair) == session.card->index);
        if (isOfPicked || session.options.has(Overlay::pairs)) {
            addLink(pair, palette_.line);
        }
    }
}

void PictureMaker::addWireBox(const StageBody& body, Colour colour) {
    if (body.shape == StageBody::Shape::none) {
        return;
    }
    const Aabb<float> box = boxAround(body);
    std::array<Vector3<float>, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] = box.corner(static_cast<Aabb<float>::CornerType>(i));  // bit 0 is x
    }
    addEdges(corners, colour, false, lines_);
}

void PictureMaker::addMarks(const Session& session) {
    for (const TunnelMark& mark : session.stage->tunnelMarks()) {
        lines_.push_back({mark.from, mark.to, palette_.alert, true});
    }
    if (session.options.has(Overlay::boxes)) {
        for (const std::uint32_t index : session.selected) {
            addWireBox(session.stage->body(index), palette_.selected);
        }
    } else if (session.card) {
        addWireBox(session.card->body, palette_.picked);
    }
    if (session.card) {
        addRings(session.card->body, session.pose());
    }
}

}  // namespace hashphase::demos
