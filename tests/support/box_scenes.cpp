// SPDX-License-Identifier: Zlib

#include <tests/support/box_scenes.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace hashphase::test {

template <class Scalar>
BoxScene<Scalar> spreadScene(std::string name, double scale, double middle) {
    return {std::move(name), 200, 1,
            [scale, middle](Random& random) {
                const Vector3<double> center =
                    random.pointIn(middle - 7 * scale, middle + 7 * scale);
                return boxAround<Scalar>(center, random.pointIn(0.5 * scale, scale));
            },
            [scale](Random& random, const Aabb<Scalar>& box) {
                return shifted(random, box, 0.4 * scale);
            }};
}
template <class Scalar>
Scalar hostileNumber(Random& random) {
    using Limits = std::numeric_limits<Scalar>;
    const std::array<Scalar, 16> numbers{0,
                                         Limits::denorm_min(),
                                         37 * Limits::denorm_min(),
                                         Limits::min(),
                                         Scalar(1e-30),
                                         Scalar(0.1),
                                         1,
                                         268435456,
                                         Scalar(3e9),
                                         Scalar(1e18),
                                         Scalar(1e30),
                                         Limits::max() / 2,
                                         Limits::max(),
                                         Limits::infinity(),
                                         Limits::quiet_NaN(),
                                         16777216};
    const Scalar number = numbers[random.below(numbers.size())];
    return random.chance(0.5) ? number : -number;
}

template <class Scalar>
Aabb<Scalar> hostileBox(Random& random) {
    const Vector3<double> half = random.pointIn(0, 2);
    Aabb<Scalar> box = boxAround<Scalar>(random.pointIn(-4, 4), half);
    const std::uint32_t spoiled = 1 + random.below(3);
    for (std::uint32_t i = 0; i < spoiled; ++i) {
        Vector3<Scalar>& corner = random.chance(0.5) ? box.min() : box.max();
        corner[random.axis()] = hostileNumber<Scalar>(random);
    }
    if (random.chance(0.2)) {
        std::swap(box.min(), box.max());
    }
    return box;
}

namespace {

// The paper's: spheres of radius 1 on flat ground of 400 x 400.
template <class Scalar>
BoxScene<Scalar> paperScene() {
    return {"the paper's spheres on flat ground", 600, 1,
            [](Random& random) {
                return boxAround<Scalar>({random.between(0, 400), random.between(0, 400), 1},
                                         {1, 1, 1});
            },
            [](Random& random, const Aabb<Scalar>& box) {
                const auto byY = static_cast<Scalar>(random.between(-1, 1));
                const Vector3<Scalar> by(static_cast<Scalar>(random.between(-1, 1)), byY, 0);
                return Aabb<Scalar>(box.min() + by, box.max() + by);
            }};
}

template <class Scalar>
BoxScene<Scalar> sizesScene() {
    return {"sizes from 1e-3 to 1e3", 200, 1,
            [](Random& random) {
                const double half = random.logBetween(0.5e-3, 0.5e3);
                return boxAround<Scalar>(random.pointIn(-500, 500),
                                         Vector3<double>::Constant(half));
            },
            [](Random& random, const Aabb<Scalar>& box) {
                return shifted(random, box, 0.3 * static_cast<double>(box.sizes()[0]));
            }};
}

// Plates without thickness, all in one plane.
template <class Scalar>
BoxScene<Scalar> plateScene() {
    return {
        "plates in one plane", 200, 1,
        [](Random& random) {
            const Vector3<double> half{random.between(0, 2), 0, random.between(0, 2)};
            return boxAround<Scalar>({random.between(-20, 20), 3, random.between(-20, 20)}, half);
        },
        [](Random& random, const Aabb<Scalar>& box) {
            const auto byZ = static_cast<Scalar>(random.between(-0.5, 0.5));
            const Vector3<Scalar> by(static_cast<Scalar>(random.between(-0.5, 0.5)), 0, byZ);
            return Aabb<Scalar>(box.min() + by, box.max() + by);
        }};
}

// A few dense piles in a domain that is empty otherwise.
template <class Scalar>
BoxScene<Scalar> pileScene() {
    return {"dense piles far apart", 150, 1,
            [](Random& random) {
                const double pile = random.below(4);
                const Vector3<double> middle(pile * 3000 - 5000, pile * 1000, 7000 - pile * 4000);
                const Vector3<double> half = random.pointIn(0.3, 0.6);
                return boxAround<Scalar>(middle + random.pointIn(-2, 2), half);
            },
            [](Random& random, const Aabb<Scalar>& box) { return shifted(random, box, 0.2); }};
}

// Boxes whose borders are multiples of `edge`, as rounded: they touch exactly or not at all.
template <class Scalar>
BoxScene<Scalar> latticeScene(std::string name, double edge, double lowest) {
    const auto boxAt = [edge](const Vector3<double>& lattice, double cells) {
        const Vector3<double> top = (lattice.array() + cells).matrix();
        return Aabb<Scalar>((lattice * edge).template cast<Scalar>(),
                            (top * edge).template cast<Scalar>());
    };
    return {std::move(name), 150, 1,
            [boxAt, lowest](Random& random) {
                const Vector3<double> steps = random.pointIn(0, 9).array().floor().matrix();
                return boxAt((steps.array() + lowest).matrix(), random.below(3));
            },
            [boxAt, edge](Random& random, const Aabb<Scalar>& box) {
                Vector3<double> lattice =
                    (box.min().template cast<double>() / edge).array().round().matrix();
                const double cells = std::round(static_cast<double>(box.sizes()[0]) / edge);
                lattice[random.axis()] += random.chance(0.5) ? 1 : -1;
                return boxAt(lattice, cells);
            }};
}

// Unit boxes among half-spaces as Bullet's planes have them.
template <class Scalar>
BoxScene<Scalar> planeScene() {
    BoxScene<Scalar> scene = spreadScene<Scalar>("half-spaces among small boxes", 1, 0);
    const double huge = sizeof(Scalar) == sizeof(float) ? 1e18 : 1e30;
    scene.draw = [huge, drawSmall = scene.draw](Random& random) {
        if (!random.chance(0.04)) {
            return drawSmall(random);
        }
        Aabb<Scalar> plane = makeBox<Scalar>(-huge, -huge, -huge, huge, huge, huge);
        plane.max()[random.axis()] = static_cast<Scalar>(random.between(-5, 5));
        return plane;
    };
    return scene;
}

// Points without extent, many of them at the same places.
template <class Scalar>
BoxScene<Scalar> pointScene() {
    return {"points", 150, 1,
            [](Random& random) {
                const Vector3<double> point = random.pointIn(0, 4).array().floor().matrix();
                return boxAround<Scalar>(point, Vector3<double>::Zero());
            },
            [](Random& random, const Aabb<Scalar>& box) {
                Aabb<Scalar> moved = box;
                const int axis = random.axis();
                moved.min()[axis] += 1;
                moved.max()[axis] += 1;
                return moved;
            }};
}

// Boxes that stay near where they are for a while, each by itself, as in a pile before it sleeps.
template <class Scalar>
BoxScene<Scalar> nearScene(std::string name,
                           std::function<Aabb<Scalar>(Random&, const Aabb<Scalar>&)> nudge) {
    BoxScene<Scalar> scene = spreadScene<Scalar>(std::move(name), 1, 0);
    scene.nudge = std::move(nudge);
    return scene;
}

// Each in a direction of its own, which its edges tell.
template <class Scalar>
Aabb<Scalar> crept(const Aabb<Scalar>& box) {
    const Vector3<Scalar> by =
        (box.sizes().array() - Scalar(1.5)).matrix().cwiseMax(-1).cwiseMin(1) * Scalar(0.01);
    return {box.min() + by, box.max() + by};
}

// Grown or shrunk, and not to nothing.
template <class Scalar>
Aabb<Scalar> breathed(Random& random, const Aabb<Scalar>& box) {
    const auto by = static_cast<Scalar>(random.between(-0.02, 0.02));
    const Scalar by0 = box.sizes().minCoeff() < Scalar(0.5) ? std::abs(by) : by;
    const Vector3<Scalar> grown = Vector3<Scalar>::Constant(by0);
    return {box.min() - grown, box.max() + grown};
}

}  // namespace

template <class Scalar>
BoxScene<Scalar> hostileScene() {
    BoxScene<Scalar> scene = spreadScene<Scalar>("hostile numbers", 1, 0);
    scene.draw = [drawSmall = scene.draw](Random& random) {
        return random.chance(0.5) ? hostileBox<Scalar>(random) : drawSmall(random);
    };
    return scene;
}

// Far from the origin, boxes grow with the distance between the numbers there.
template <class Scalar>
std::vector<BoxScene<Scalar>> allBoxScenes() {
    using Limits = std::numeric_limits<Scalar>;
    const auto atLeastUlps = [](double distance) {
        return std::max(1.0, 3 * distance * static_cast<double>(Limits::epsilon()));
    };
    std::vector<BoxScene<Scalar>> scenes{
        spreadScene<Scalar>("evenly spread", 1, 0),
        spreadScene<Scalar>("evenly spread, mostly static", 1, 0),
        spreadScene<Scalar>("at 1e6", atLeastUlps(1e6), 1e6),
        spreadScene<Scalar>("at -1e9", atLeastUlps(1e9), -1e9),
        spreadScene<Scalar>("denormal", 64 * static_cast<double>(Limits::denorm_min()), 0),
        spreadScene<Scalar>("enormous", static_cast<double>(Limits::max()) / 9, 0),
        paperScene<Scalar>(),
        sizesScene<Scalar>(),
        plateScene<Scalar>(),
        pileScene<Scalar>(),
        latticeScene<Scalar>("lattice of 1", 1, -4),
        latticeScene<Scalar>("lattice of 0.1", 0.1, 30),
        planeScene<Scalar>(),
        pointScene<Scalar>(),
        hostileScene<Scalar>(),
        nearScene<Scalar>(
            "trembling",
            [](Random& random, const Aabb<Scalar>& box) { return shifted(random, box, 0.02); }),
        nearScene<Scalar>("creeping", [](Random&, const Aabb<Scalar>& box) { return crept(box); }),
        nearScene<Scalar>("breathing", breathed<Scalar>),
        nearScene<Scalar>("trembling, and some travelling",
                          [](Random& random, const Aabb<Scalar>& box) {
                              const bool travels = box.sizes()[0] > Scalar(1.8);
                              return shifted(random, box, travels ? 0.4 : 0.02);
                          })};
    scenes[1].mobileShare = 0.1;
    return scenes;
}
template BoxScene<float> spreadScene<float>(std::string, double, double);
template float hostileNumber<float>(Random&);
template Aabb<float> hostileBox<float>(Random&);
template BoxScene<float> hostileScene<float>();
template std::vector<BoxScene<float>> allBoxScenes<float>();

template BoxScene<double> spreadScene<double>(std::string, double, double);
template double hostileNumber<double>(Random&);
template Aabb<double> hostileBox<double>(Random&);
template BoxScene<double> hostileScene<double>();
template std::vector<BoxScene<double>> allBoxScenes<double>();

}  // namespace hashphase::test
