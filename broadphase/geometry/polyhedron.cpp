// SPDX-License-Identifier: Zlib

// Small volumes only: corners are found by intersecting every three planes.

#include <broadphase/geometry/polyhedron.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

namespace hashphase::detail {
namespace {

constexpr double kEpsilon = 16 * std::numeric_limits<double>::epsilon();

// Planes of which the normals are less independent than this count as parallel.
constexpr double kParallel = 1e-12;

// Edges shorter than this share of what is around them count as none.
constexpr double kShort = 1e-9;

constexpr double kDoubleInfinity = std::numeric_limits<double>::infinity();

bool isSamePlane(const Polyhedron::Plane& a, const Polyhedron::Plane& b) {
    return (a.normal() - b.normal()).cwiseAbs().maxCoeff() <= kShort &&
           std::abs(a.offset() - b.offset()) <= kShort * std::abs(a.offset());
}

}  // namespace

Polyhedron::Polyhedron(const Planes& planes) {
    findCorners(planes);
    if (spansSpace_) {
        findDirections(planes);
    } else {
        findSlice(planes);
    }
}

// The volume goes on for ever, both ways, along lines that no plane slopes along. What there is to know
// of it shows in a slice across these.
void Polyhedron::findSlice(const Planes& planes) {
    using Matrix3 = Eigen::Matrix<double, 3, 3, Eigen::DontAlign>;
    Matrix3 normals = Matrix3::Zero();
    for (const Plane& plane : planes) {
        normals += plane.normal() * plane.normal().transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Matrix3> axes(normals);
    Planes slice = planes;
    int lines = 0;
    for (; lines < 3 && !spansSpace_; ++lines) {
        const Vector3<double> line = axes.eigenvectors().col(lines);
        slice.push(Plane(line, 0));
        slice.push(Plane(-line, 0));
        findCorners(slice);
    }
    findDirections(slice);
    for (int i = 0; i < lines; ++i) {
        const Vector3<double> line = axes.eigenvectors().col(i);
        const std::uint32_t all = (1U << planes.size()) - 1;
        hasTooMany_ = !directions_.push({line, all}) || hasTooMany_;
        hasTooMany_ = !directions_.push({-line, all}) || hasTooMany_;
    }
}

void Polyhedron::findCorners(const Planes& planes) {
    for (std::size_t i = 0; i < planes.size(); ++i) {
        for (std::size_t j = i + 1; j < planes.size(); ++j) {
            const Vector3<double> along = planes[i].normal().cross(planes[j].normal());
            for (std::size_t k = j + 1; k < planes.size(); ++k) {
                const double determinant = along.dot(planes[k].normal());
                if (!(std::abs(determinant) > kParallel)) {
                    continue;
                }
                spansSpace_ = true;
                const Vector3<double> point =
                    (planes[i].offset() * planes[k].normal().cross(planes[j].normal()) +
                     planes[j].offset() * planes[i].normal().cross(planes[k].normal()) -
                     planes[k].offset() * along) /
                    determinant;
                const double reach = std::abs(planes[i].offset()) + std::abs(planes[j].offset()) +
                                     std::abs(planes[k].offset());
                const double error = kEpsilon * (reach + 3 * point.cwiseAbs().sum());
                addCorner({point, error / std::abs(determinant)}, planes);
            }
        }
    }
}

// Adds the point if no plane has it outside; one where more than three planes meet comes up again,
// rounded in another way.
void Polyhedron::addCorner(Corner corner, const Planes& planes) {
    const double doubt = corner.error + kEpsilon * corner.point.cwiseAbs().sum();
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const double distance = planes[i].signedDistance(corner.point);
        const double about = doubt + kEpsilon * std::abs(planes[i].offset());
        if (distance < -about) {
            return;
        }
        corner.planes |= (distance <= about ? 1U : 0U) << i;
    }
    for (Corner& other : corners_) {
        const double distance = (corner.point - other.point).norm();
        if (distance <= doubt + other.error) {
            other.error = std::max(other.error, distance + corner.error);
            other.planes |= corner.planes;
            return;
        }
    }
    hasTooMany_ = !corners_.push(corner) || hasTooMany_;
}

void Polyhedron::findDirections(const Planes& planes) {
    for (std::size_t i = 0; i < planes.size(); ++i) {
        for (std::size_t j = i + 1; j < planes.size(); ++j) {
            const Vector3<double> along = planes[i].normal().cross(planes[j].normal());
            const double length = along.norm();
            if (!(length > kParallel)) {
                continue;
            }
            for (const double sign : {1.0, -1.0}) {
                Direction direction{along * (sign / length)};
                bool isWithin = true;
                for (std::size_t k = 0; k < planes.size() && isWithin; ++k) {
                    const double slope = planes[k].normal().dot(direction.way);
                    isWithin = slope >= -kParallel;
                    direction.planes |= (slope <= kParallel ? 1U : 0U) << k;
                }
                if (isWithin) {
                    hasTooMany_ = !directions_.push(direction) || hasTooMany_;
                }
            }
        }
    }
}

// Appends the plane across `normal`, of length 1, that just has the whole volume inside, if there is
// one.
void Polyhedron::appendAround(const Vector3<double>& normal, Planes& planes) const {
    for (const Direction& direction : directions_) {
        if (normal.dot(direction.way) < -kParallel) {
            return;
        }
    }
    double least = kDoubleInfinity;
    for (const Corner& corner : corners_) {
        const double doubt = corner.error + kEpsilon * corner.point.cwiseAbs().sum();
        least = std::min(least, normal.dot(corner.point) - doubt);
    }
    const Plane plane(normal, -least);
    const auto isSame = [&plane](const Plane& other) { return isSamePlane(plane, other); };
    if (std::none_of(planes.begin(), planes.end(), isSame)) {
        planes.push(plane);
    }
}

// Appends the planes through an edge and along an axis that have the whole volume on one side.
void Polyhedron::appendAlong(int axis, const Corner& corner, const Vector3<double>& edge,
                             double error, Planes& planes) const {
    const double length = edge.norm();
    Vector3<double> normal = Vector3<double>::Unit(axis).cross(edge);
    const double size = normal.norm();
    if (!(size > kShort * length)) {
        return;
    }
    normal /= size;
    // Where the volume lies on both sides, the edge is not seen along this axis.
    double least = 0;
    double most = 0;
    for (const Corner& other : corners_) {
        const double distance = normal.dot(other.point - corner.point);
        least = std::min(least, distance);
        most = std::max(most, distance);
    }
    const double doubt = 4 * (corner.error + error) + kShort * length;
    if (least >= -doubt) {
        appendAround(normal, planes);
    }
    if (most <= doubt) {
        appendAround(-normal, planes);
    }
}

bool Polyhedron::isInside(const Plane& plane, double margin) const {
    for (const Direction& direction : directions_) {
        if (plane.normal().dot(direction.way) < -kParallel) {
            return false;
        }
    }
    for (const Corner& corner : corners_) {
        const double doubt = corner.error + kEpsilon * corner.point.cwiseAbs().sum();
        if (!(plane.signedDistance(corner.point) - doubt >= margin)) {
            return false;
        }
    }
    return !corners_.empty() && !hasTooMany_;
}

void Polyhedron::appendSilhouettes(bool isExact, Planes& planes) const {
    if (corners_.empty() || hasTooMany_) {
        return;
    }
    for (int axis = isExact ? 0 : 1; axis < 3; ++axis) {
        appendAround(Vector3<double>::Unit(axis), planes);
        appendAround(-Vector3<double>::Unit(axis), planes);
    }
    // An edge lies in two planes of the volume.
    const auto areOnEdge = [](std::uint32_t a, std::uint32_t b) {
        return std::popcount(a & b) > 1;
    };
    for (int axis = 0; axis < (isExact ? 3 : 1); ++axis) {
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            const Corner& corner = corners_[i];
            for (std::size_t j = i + 1; j < corners_.size(); ++j) {
                if (areOnEdge(corner.planes, corners_[j].planes)) {
                    const Vector3<double> edge = corners_[j].point - corner.point;
                    appendAlong(axis, corner, edge, corners_[j].error, planes);
                }
            }
            for (const Direction& direction : directions_) {
                if (areOnEdge(corner.planes, direction.planes)) {
                    appendAlong(axis, corner, direction.way, 0, planes);
                }
            }
        }
    }
}

}  // namespace hashphase::detail
