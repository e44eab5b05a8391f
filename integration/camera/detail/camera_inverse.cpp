// SPDX-License-Identifier: Zlib
#include <integration/camera/detail/camera_inverse.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace hashphase::detail {
namespace {

// By Gauss and Jordan, with the largest number that is left as each pivot. None where one is not above
// `threshold` times the largest. Not Eigen::FullPivLU, whose code would depend on the options of the program.
std::optional<Matrix4<double>> inverseByPivots(Matrix4<double> matrix, double threshold) {
    Matrix4<double> inverse = Matrix4<double>::Identity();
    std::array<std::pair<int, int>, 4> pivots;
    double largest = 0;
    for (int k = 0; k < 4; ++k) {
        auto [row, column] = std::pair(k, k);
        for (int c = k; c < 4; ++c) {
            for (int r = k; r < 4; ++r) {
                if (std::abs(matrix(r, c)) > std::abs(matrix(row, column))) {
                    row = r;
                    column = c;
                }
            }
        }
        const double pivot = matrix(row, column);
        largest = std::max(largest, std::abs(pivot));
        if (!(std::abs(pivot) > threshold * largest)) {
            return std::nullopt;
        }
        pivots[static_cast<std::size_t>(k)] = {k, column};
        for (int i = 0; i < 4; ++i) {
            std::swap(matrix(k, i), matrix(row, i));
            std::swap(inverse(k, i), inverse(row, i));
        }
        for (int i = 0; i < 4; ++i) {
            std::swap(matrix(i, k), matrix(i, column));
        }
        for (int i = 0; i < 4; ++i) {
            matrix(k, i) /= pivot;
            inverse(k, i) /= pivot;
        }
        for (int r = 0; r < 4; ++r) {
            if (r == k) {
                continue;
            }
            const double share = matrix(r, k);
            for (int i = 0; i < 4; ++i) {
                matrix(r, i) -= share * matrix(k, i);
                inverse(r, i) -= share * inverse(k, i);
            }
        }
    }
    std::for_each(pivots.rbegin(), pivots.rend(), [&](const auto& exchanged) {
        for (int i = 0; i < 4; ++i) {
            std::swap(inverse(exchanged.first, i), inverse(exchanged.second, i));
        }
    });
    return inverse;
}

// None for a matrix that is singular or not finite.
std::optional<Matrix4<double>> inverseOf(const Matrix4<double>& matrix) {
    if (!matrix.allFinite()) {
        return std::nullopt;
    }
    // Rows and columns of like size: a camera far from the origin, or with planes near 0 and far
    // away, is no less regular than any other.
    Matrix4<double> scaled = matrix;
    const Vector4<double> rows = scaled.cwiseAbs().rowwise().maxCoeff().cwiseInverse();
    scaled.array().colwise() *= rows.array();
    const Vector4<double> columns =
        scaled.cwiseAbs().colwise().maxCoeff().cwiseInverse().transpose();
    scaled.array().rowwise() *= columns.array().transpose();
    if (!scaled.allFinite()) {
        return std::nullopt;  // a row or a column is zero
    }
    std::optional<Matrix4<double>> inverse = inverseByPivots(scaled, 1e-14);
    if (inverse) {
        inverse->array().colwise() *= columns.array();
        inverse->array().rowwise() *= rows.array().transpose();
    }
    return inverse && inverse->allFinite() ? inverse : std::nullopt;
}

}  // namespace

CameraInverse::CameraInverse(const Matrix4<double>& viewProjection)
    : weightPerMetre_(viewProjection.block<1, 3>(3, 0).stableNorm()) {
    const std::optional<Matrix4<double>> inverse = inverseOf(viewProjection);
    if (!inverse) {
        return;
    }
    inverse_ = *inverse;
    isValid_ = true;
    // Whichever way depth runs, the nearer of these is in front of the eye, and not at infinity.
    const Vector4<double> first = at(0, 0, 0);
    const Vector4<double> second = at(0, 0, 1);
    const Vector4<double>& near = std::abs(first.w()) > std::abs(second.w()) ? first : second;
    const Eigen::Vector3d origin = near.head<3>() / near.w();
    Matrix4<double> shifted = viewProjection;
    shifted.col(3).noalias() += viewProjection.leftCols<3>() * origin;
    if (const std::optional<Matrix4<double>> closer = inverseOf(shifted)) {
        inverse_ = *closer;
        origin_ = origin;
    }
}

}  // namespace hashphase::detail
