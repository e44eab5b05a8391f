// SPDX-License-Identifier: Zlib
//
// A camera that orbits around a point. Matrices are columns one after another, as WebGL takes them.

const FIELD_OF_VIEW = 0.7; // from bottom to top [rad]
const STEEPEST = 1.5; // above the horizon [rad]

const minus = (a, b) => a.map((each, i) => each - b[i]);
const dot = (a, b) => a.reduce((sum, each, i) => sum + each * b[i], 0);
const cross = (a, b) => [
    a[1] * b[2] - a[2] * b[1],
    a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0],
];
const scaled = (a, factor) => a.map((each) => each * factor);
const plus = (a, b) => a.map((each, i) => each + b[i]);
const unit = (a) => scaled(a, 1 / Math.hypot(...a));

function product(a, b) {
    return Float32Array.from({ length: 16 }, (_, i) => {
        const row = i % 4;
        const column = i - row;
        return (
            a[row] * b[column] +
            a[row + 4] * b[column + 1] +
            a[row + 8] * b[column + 2] +
            a[row + 12] * b[column + 3]
        );
    });
}

class OrbitCamera {
    constructor(centre, radius) {
        this.home = { target: centre, distance: radius * 2 };
        this.radius = radius;
        this.reset();
    }

    reset() {
        Object.assign(this, this.home, { azimuth: 0.6, elevation: 0.5 });
    }

    lookDown() {
        Object.assign(this, this.home, { azimuth: 0, elevation: STEEPEST });
    }

    lookAt(target, distance) {
        Object.assign(this, { target, distance });
    }

    orbit(sideways, up) {
        this.azimuth += sideways;
        this.elevation = Math.min(STEEPEST, Math.max(-STEEPEST, this.elevation + up));
    }

    zoom(factor) {
        const { distance } = this.home;
        this.distance = Math.min(distance * 4, Math.max(distance * 1e-4, this.distance * factor));
    }

    // By shares of the picture's height.
    pan(right, up) {
        const height = 2 * this.distance * Math.tan(FIELD_OF_VIEW / 2);
        const { rightward, upward } = this.axes();
        this.target = plus(
            this.target,
            plus(scaled(rightward, -right * height), scaled(upward, up * height)),
        );
    }

    axes() {
        const [s, c] = [Math.sin(this.elevation), Math.cos(this.elevation)];
        const backward = [Math.sin(this.azimuth) * c, s, Math.cos(this.azimuth) * c];
        const rightward = unit(cross([0, 1, 0], backward));
        return { backward, rightward, upward: cross(backward, rightward) };
    }

    view(aspect) {
        const { backward, rightward, upward } = this.axes();
        const eye = plus(this.target, scaled(backward, this.distance));
        const view = new Float32Array(16);
        [rightward, upward, backward].forEach((axis, row) => {
            axis.forEach((each, column) => (view[4 * column + row] = each));
            view[12 + row] = -dot(axis, eye);
        });
        view[15] = 1;
        const near = this.distance / 100;
        const far = this.distance + 20 * this.radius;
        const scale = 1 / Math.tan(FIELD_OF_VIEW / 2);
        const projection = new Float32Array(16);
        projection[0] = scale / aspect;
        projection[5] = scale;
        projection[10] = (near + far) / (near - far);
        projection[11] = -1;
        projection[14] = (2 * near * far) / (near - far);
        return { eye, view, projection, both: product(projection, view) };
    }
}

// Where the point is in a picture of that size, from its lower left; nothing behind the camera.
function placeInPicture(matrix, [x, y, z], width, height) {
    const row = (i) => matrix[i] * x + matrix[i + 4] * y + matrix[i + 8] * z + matrix[i + 12];
    const w = row(3);
    return w > 0 ? [((row(0) / w + 1) / 2) * width, ((row(1) / w + 1) / 2) * height] : undefined;
}
