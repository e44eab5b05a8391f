// SPDX-License-Identifier: Zlib
//
// A camera that orbits around a point.

const FIELD_OF_VIEW = 0.7; // from bottom to top [rad]
const STEEPEST = 1.5; // above the horizon [rad]

const minus = (a, b) => a.map((each, i) => each - b[i]);
const degrees = (radians) => (radians * 180) / Math.PI;

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
        const way = this.inWorld({ x: -right * height, y: up * height });
        this.target = minus(this.target, minus([0, 0, 0], way));
    }

    // From the world's axes to the picture's: rightward, upward, backward.
    turn() {
        return new DOMMatrix()
            .rotateAxisAngle(1, 0, 0, degrees(this.elevation))
            .rotateAxisAngle(0, 1, 0, -degrees(this.azimuth));
    }

    inWorld(wayInPicture) {
        const { x, y, z } = this.turn().inverse().transformPoint(wayInPicture);
        return [x, y, z];
    }

    view(aspect) {
        const [x, y, z] = this.target;
        const view = new DOMMatrix()
            .translate(0, 0, -this.distance)
            .multiply(this.turn())
            .translate(-x, -y, -z);
        const near = this.distance / 100;
        const far = this.distance + 20 * this.radius;
        const scale = 1 / Math.tan(FIELD_OF_VIEW / 2);
        const [slope, shift] = [(near + far) / (near - far), (2 * near * far) / (near - far)];
        // Columns one after another.
        const projection = new DOMMatrix([
            scale / aspect, 0, 0, 0, 0, scale, 0, 0, 0, 0, slope, -1, 0, 0, shift, 0,
        ]);
        return {
            eye: minus(this.target, this.inWorld({ z: -this.distance })),
            view: view.toFloat32Array(),
            projection: projection.toFloat32Array(),
            both: projection.multiply(view).toFloat32Array(),
        };
    }
}

// Where the point is in a picture of that size, from its lower left; nothing behind the camera.
function placeInPicture(matrix, [x, y, z], width, height) {
    const at = DOMMatrix.fromFloat32Array(matrix).transformPoint({ x, y, z });
    return at.w > 0
        ? [((at.x / at.w + 1) / 2) * width, ((at.y / at.w + 1) / 2) * height]
        : undefined;
}

// Dragging orbits, with Shift or the right button it pans, two fingers zoom; so does the wheel.
function steerByPointer(canvas, camera, changed) {
    const pointers = new Map();
    const fingersApart = () => {
        const [a, b] = [...pointers.values()];
        return Math.hypot(a.x - b.x, a.y - b.y);
    };
    canvas.addEventListener("pointerdown", (event) => {
        canvas.setPointerCapture(event.pointerId);
        pointers.set(event.pointerId, { x: event.clientX, y: event.clientY });
    });
    canvas.addEventListener("pointermove", (event) => {
        const last = pointers.get(event.pointerId);
        if (!last) {
            return;
        }
        const apart = pointers.size === 2 ? fingersApart() : 0;
        const [dx, dy] = [event.clientX - last.x, event.clientY - last.y];
        Object.assign(last, { x: event.clientX, y: event.clientY });
        if (apart > 0) {
            camera.zoom(apart / Math.max(1, fingersApart()));
        } else if (event.shiftKey || event.buttons & 2) {
            camera.pan(dx / canvas.clientHeight, dy / canvas.clientHeight);
        } else {
            camera.orbit(-dx * 0.008, dy * 0.008);
        }
        changed();
    });
    for (const end of ["pointerup", "pointercancel"]) {
        canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
    }
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    const wheel = (event) => {
        event.preventDefault();
        camera.zoom(Math.exp(event.deltaY * 0.0015));
        changed();
    };
    canvas.addEventListener("wheel", wheel, { passive: false });
}
