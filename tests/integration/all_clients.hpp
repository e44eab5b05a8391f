// SPDX-License-Identifier: Zlib
#pragma once

// Everything that a game asks of a grid in a frame, and what it found.

#include <integration/ai/nearest.hpp>
#include <integration/ai/proximity.hpp>
#include <integration/ai/radar.hpp>
#include <integration/ai/rarest_colour.hpp>
#include <integration/ai/sight.hpp>
#include <integration/ai/zones.hpp>
#include <integration/camera/frustum.hpp>
#include <integration/culling/culler.hpp>
#include <integration/picking/drag_selection.hpp>
#include <integration/picking/ground.hpp>
#include <integration/picking/pick.hpp>
#include <tests/support/camera_matrices.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

namespace hashphase::test {

template <class Scalar>
struct AllClients {
    using Accept = std::function<bool(ProxyId)>;

    /// Eyes that look along x, of whom the first one stands in zones, and colours for indices of proxies
    /// below a limit.
    AllClients(const std::vector<Vector3<Scalar>>& eyes, std::size_t indexLimit, Accept isWanted,
               Accept doesBlock)
        : accepts(std::move(isWanted)), blocks(std::move(doesBlock)) {
        const Vector3<Scalar> far = eyes[0] + Vector3<Scalar>::Constant(200);
        static_cast<void>(zones.add({SphereRegion<Scalar>(eyes[0], 30)}));
        static_cast<void>(zones.add({BoxRegion<Scalar>{{eyes[0], far}}}));
        for (const Vector3<Scalar>& eye : eyes) {
            viewers.push_back({.eye = eye, .range = 40, .halfAngle = Scalar(0.5)});
        }
        for (std::uint32_t i = 0; i < indexLimit; ++i) {
            colours.push_back(i * i % 5);
        }
    }

    void ask(const Grid<Scalar>& grid) {
        askByCamera(grid);
        askByAgents(grid);
        const ZoneEvents events = zones.update(grid);
        entered.assign(events.entered.begin(), events.entered.end());
        left.assign(events.left.begin(), events.left.end());
        // At last, so that colours change once though memory runs out.
        rarest_.update(grid, kRadius, 5, colours, [this](ProxyId id) { return !blocks(id); });
    }

    /// To be compared.
    [[nodiscard]] auto answers() const {
        return std::tie(within, estimated, nearest, seen, counts, colours, neighbourCounts, visible,
                        picked, selected, onMap);
    }
    [[nodiscard]] std::size_t size() const {
        return within.size() + estimated.size() + nearest.size() + seen.size() + visible.size() +
               picked.size() + selected.size() + onMap.size() + entered.size() + left.size();
    }

    /// Above the first viewer.
    [[nodiscard]] Camera<Scalar> camera() const {
        const Vector3<double> eye =
            viewers[0].eye.template cast<double>() + Vector3<double>(0, 20, 0);
        return {cameraMatrix<Scalar>({}, eye, eye + Vector3<double>(1, -0.3, 0.2)),
                DepthRange::zeroToOne,
                {0, 0, 800, 500}};
    }
    /// The agents of `neighbourCounts`.
    [[nodiscard]] const RadiusSearch<Scalar>& agents() const { return search_; }

    static constexpr Scalar kRadius = 10;  // within which agents have neighbours [m]
    static constexpr std::size_t kNearest = 9;
    inline static const Pixel kPointer{400, 250};
    inline static const Pixel kDragFrom{300, 400};
    inline static const Pixel kDragTo{100, 100};

    // What was found; of several viewers, of one after the other.
    std::vector<ProxyId> within;
    std::vector<ProxyId> estimated;
    std::vector<KeyedProxy<Scalar>> nearest;
    std::vector<ProxyId> seen;
    std::vector<std::uint32_t> counts;
    std::vector<std::uint32_t> colours;
    std::vector<std::uint32_t> neighbourCounts;
    std::vector<std::uint32_t> visible;
    std::vector<ProxyId> picked;  // all, those of the ground, and the nearest one
    std::vector<ProxyId> selected;
    std::vector<ProxyId> onMap;
    std::vector<ZoneEvent> entered;
    std::vector<ZoneEvent> left;

    std::vector<Viewer<Scalar>> viewers;
    Zones<Scalar> zones;
    Accept accepts;
    Accept blocks;

private:
    void askByAgents(const Grid<Scalar>& grid) {
        within.clear();
        estimated.clear();
        nearest.clear();
        const auto append = [](const auto& found, auto& all) {
            all.insert(all.end(), found.begin(), found.end());
        };
        for (const Viewer<Scalar>& viewer : viewers) {
            findWithin(grid, viewer.eye, kRadius, found_, accepts);
            append(found_, within);
            estimateWithin(grid, viewer.eye, kRadius, found_, accepts);
            append(found_, estimated);
            findNearest(grid, viewer.eye, kNearest, 1000, keyed_, accepts);
            append(keyed_, nearest);
        }
        sight_.look(grid, viewers, accepts, blocks);
        seen.clear();
        for (std::size_t i = 0; i < viewers.size(); ++i) {
            seen.insert(seen.end(), sight_.seenBy(i).begin(), sight_.seenBy(i).end());
        }
        const auto scanned =
            radar_.scan(grid, {.center = viewers[0].eye, .cellSize = 20, .columns = 8, .rows = 8},
                        2, [this](ProxyId id) { return accepts(id) ? 1U : 0U; });
        counts.assign(scanned.begin(), scanned.end());
        search_.take(grid, kRadius, [this](ProxyId id) { return !blocks(id); });
        neighbourCounts.resize(search_.size());
        search_.count(neighbourCounts);
    }

    void askByCamera(const Grid<Scalar>& grid) {
        const Camera<Scalar> camera = this->camera();
        culler_.look(grid, frustumRegion<Scalar>(camera.viewProjection(), camera.depthRange()));
        visible.clear();
        culler_.forEach([this](std::uint32_t index) { visible.push_back(index); });

        const RayRegion<Scalar> ray = camera.rayThrough(kPointer);
        picked.clear();
        const auto append = [this] {
            for (const Picked<Scalar>& each : all_) {
                picked.push_back(each.id);
            }
        };
        pickAll(grid, ray, all_, [](ProxyId, const RayRegion<Scalar>&, Scalar limit) {
            return std::optional(limit);
        });
        append();
        pickAll(grid, clipToHeights(ray, {-5, 5}), all_);
        append();
        picked.push_back(pickNearest(grid, ray, accepts).id);

        select(grid, camera, kDragFrom, kDragTo, selected);
        CollectAll collector(onMap);
        onMap.clear();
        grid.visit(dragFootprint(camera, kDragFrom, kDragTo, {-5, 5}).region(), collector);
        std::sort(onMap.begin(), onMap.end());
    }

    Sight<Scalar> sight_;
    Radar<Scalar> radar_;
    RadiusSearch<Scalar> search_;
    RarestColour<Scalar> rarest_;
    Culler<Scalar> culler_;
    std::vector<Picked<Scalar>> all_;
    std::vector<ProxyId> found_;
    std::vector<KeyedProxy<Scalar>> keyed_;
};

}  // namespace hashphase::test
