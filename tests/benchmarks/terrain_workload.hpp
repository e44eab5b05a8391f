// SPDX-License-Identifier: Zlib
#pragma once

// Where on the ground is everybody? Spheres roam over hills of triangles; in every frame all of them
// move, and each asks for the height of the ground below, or for the height at which it rests.
//
// Answers   1 where the height is the exact one, but for 1 cm, else 2. Exact is what the nearest
//           points of all triangles around say, in long double.

#include <tests/benchmarks/catalog.hpp>
#include <tests/benchmarks/workload.hpp>

#include <demos/scenes/random.hpp>
#include <tests/support/terrain_oracle.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace hashphase::benchmarks {

enum class GroundQuestion : std::uint8_t { surface, rest };

/// Hills over a square: 160 x 160 quads of 2.5 m, in two triangles each.
class HillMesh {
public:
    static constexpr std::uint32_t kQuads = 160;  // a side
    static constexpr float kEdge = 2.5F;          // [m]
    static constexpr float kHalf = 0.5F * kQuads * kEdge;

    explicit HillMesh(std::uint64_t seed);

    [[nodiscard]] const std::vector<Vector3<float>>& vertices() const noexcept { return vertices_; }
    [[nodiscard]] const std::vector<std::uint32_t>& indices() const noexcept { return indices_; }

    /// How far `height` is from what is exact for a sphere, radius 0 for the surface [m].
    [[nodiscard]] double error(const Vector3<float>& center, float radius, float height) const;

private:
    [[nodiscard]] test::RealTriangle triangle(std::uint32_t number) const;

    std::vector<Vector3<float>> vertices_;
    std::vector<std::uint32_t> indices_;
};

/// Everybody's place and size in a frame.
struct Spheres {
    std::vector<Vector3<float>> centers;
    std::vector<float> radii;
};

/// Who answers.
class GroundContestant {
public:
    GroundContestant() = default;
    GroundContestant(const GroundContestant&) = delete;
    GroundContestant& operator=(const GroundContestant&) = delete;
    virtual ~GroundContestant() = default;

    /// Writes everybody's height; NaN for none.
    virtual void ask(GroundQuestion question, const Spheres& spheres, std::span<float> heights) = 0;

    [[nodiscard]] virtual std::optional<OwnBytes> ownBytes() const { return std::nullopt; }
};

/// Those who take part, by name.
[[nodiscard]] std::vector<ContestantKind> groundKinds(GroundQuestion question);

[[nodiscard]] std::unique_ptr<GroundContestant> makeGroundContestant(std::string_view name,
                                                                     const HillMesh& mesh);

class TerrainWorkload : public Workload {
public:
    TerrainWorkload(GroundQuestion question, std::size_t spheres, std::uint64_t seed);

    void add(const ContestantKind& kind) override;
    void beginFrame() override;
    double runFrame(std::size_t contestant) override;
    void listAnswers(std::size_t contestant, std::vector<Answer>& answers) override;
    void listExactAnswers(std::vector<Answer>& answers) override;
    [[nodiscard]] Memory memory(std::size_t contestant) const override;
    [[nodiscard]] std::size_t objects() const override { return spheres_.centers.size(); }
    [[nodiscard]] std::size_t operations() const override { return objects(); }

private:
    struct Entry {
        std::unique_ptr<GroundContestant> contestant;
        bool onThreads = false;
        std::vector<float> heights;
    };

    GroundQuestion question_;
    HillMesh mesh_;
    demos::Random random_;
    Spheres spheres_;
    std::vector<Vector3<float>> ways_;  // a frame [m]
    std::vector<Entry> entries_;
};

}  // namespace hashphase::benchmarks
