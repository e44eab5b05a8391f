// SPDX-License-Identifier: Zlib
//
// Replays a recording in a canvas, once its tab is shown. What is shown is told by data attributes of
// the replay's element, too: state (ready; lost while the browser has taken WebGL2 back), playing, frame,
// frames, pairs (that overlap), lines (that are drawn of them), colouring, broadphase, missing, extra, drawn (of the wrong pairs), marks (where in the picture
// the first of them is drawn, from its lower left), draws.

const KEYS_IN_WORDS =
    "Keys: Space plays and pauses, comma and full stop go a frame back and on, Home and End to the ends, " +
    "W to the first wrong pair; P shows all pairs, D dims, C colours. In the picture arrows turn the " +
    "camera, plus and minus zoom; dragging turns, with Shift it moves, the wheel zooms.";

const FRAMES_A_SECOND = [
    [60, "as recorded"],
    [30, "at half speed"],
    [10, "at 1/6"],
    [3, "at 1/20"],
];

class Replay {
    constructor(root, gl, canvas, recording) {
        this.root = root;
        this.canvas = canvas;
        this.recording = recording;
        this.frame = 0;
        this.broadphase = recording.worst();
        this.gl = gl;
        this.drawing = new Drawing(gl, recording);
        this.outline = recording.outline(recording.numbersOf(this.broadphase, 0));
        const { centre, radius, heights } = this.outline;
        this.camera = new OrbitCamera(centre, radius);
        this.look = {
            camera: this.camera,
            colouring: "cell",
            // The judged broadphase's, or else the first's that has cells.
            cellSize:
                [this.broadphase, ...recording.broadphases].find((each) => each.cellSize)?.cellSize ??
                Number((recording.typicalEdge * 8).toPrecision(2)),
            heights: [heights.low, Math.max(heights.high, heights.low + 1e-3)],
            groundEdge: Math.max(radius, 10 * recording.typicalEdge),
            spheres: recording.spheres,
            pairs: false,
            dimming: 0,
            screen: "light",
            pixels: 1,
        };
        this.draws = 0;
        this.build();
        this.followScreen();
        this.followLoss();
        this.show(0);
        root.dataset.state = "ready";
    }

    build() {
        const changed = () => this.redraw();
        steerByPointer(this.canvas, this.camera, changed);
        steerByKeys(this.canvas, this.camera, changed);
        this.followKeys();
        this.words = element("p", { class: "words", "aria-live": "polite" });
        this.counts = element("p", { class: "counts" });
        this.legend = element("p", { class: "legend" });
        this.chart = new WrongChart();
        this.root.append(
            element("div", { class: "picture" }, this.canvas, cameraButtons(this.camera, changed)),
            this.timeControls(),
            this.counts,
            this.viewControls(),
            this.legend,
            this.words,
            element("p", { class: "keys" }, KEYS_IN_WORDS),
        );
    }

    // Wherever they are pressed while the tab is shown, but where something is typed or chosen; a focused
    // button, as that of the tab itself, keeps its Space.
    followKeys() {
        const keys = {
            " ": () => this.togglePlaying(),
            ",": () => this.step(-1),
            ".": () => this.step(1),
            Home: () => this.show(0),
            End: () => this.show(this.recording.frames - 1),
            w: () => this.showFirst(),
            p: () => this.pairs.click(),
            d: () => this.dimmed.click(),
            c: () => this.chooseColouring(1 + COLOURINGS.indexOf(this.look.colouring)),
        };
        const typed = "input[type=number], select";
        const own = {
            " ": `button, summary, input[type=checkbox], ${typed}`,
            Home: "input, select",
            End: "input, select",
        };
        const panel = this.root.closest("[role=tabpanel]");
        document.addEventListener("keydown", (event) => {
            const { target, ctrlKey, altKey, metaKey } = event;
            const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
            const taken =
                panel.hidden || event.defaultPrevented || target.closest(own[key] ?? typed);
            if (keys[key] && !taken && !ctrlKey && !altKey && !metaKey) {
                event.preventDefault();
                keys[key]();
            }
        });
    }

    timeControls() {
        const { frames } = this.recording;
        this.play = button("\u25b6", "Play", () => this.togglePlaying());
        const range = { type: "range", name: "frame", min: 0, max: frames - 1, value: 0, "aria-label": "Frame" };
        this.slider = element("input", { ...range, oninput: () => this.show(Number(this.slider.value)) });
        this.number = element("output", { class: "frame" });
        this.framesASecond = 10;
        const speed = choice("Speed", "speed", FRAMES_A_SECOND, this.framesASecond, (value) => {
            this.framesASecond = Number(value);
        });
        return element(
            "div",
            { class: "time" },
            this.play,
            button("\u2039", "Frame before", () => this.step(-1)),
            button("\u203a", "Frame after", () => this.step(1)),
            element("div", { class: "scrub" }, this.chart.canvas, this.slider),
            this.number,
            speed.label,
        );
    }

    viewControls() {
        const { recording, look } = this;
        const names = (all) => all.map((each) => [each, each]);
        const broadphases = names(recording.broadphases.map(({ name }) => name));
        const judged = choice("Wrong pairs of", "broadphase", broadphases, this.broadphase.name, (name) =>
            this.judge(name),
        );
        const colourings = names(COLOURINGS);
        const coloured = choice("Colour by", "colouring", colourings, look.colouring, (colouring) =>
            this.change({ colouring }),
        );
        this.colouring = coloured.select;
        const shape = choice("Draw", "shape", names(["spheres", "boxes"]), "spheres", (name) =>
            this.change({ spheres: name === "spheres" }),
        );
        const cells = element("input", {
            type: "number",
            name: "cellSize",
            min: 0,
            step: "any",
            value: Number(look.cellSize.toPrecision(4)),
            oninput: () => Number(cells.value) > 0 && this.change({ cellSize: Number(cells.value) }),
        });
        const box = (name, onchange) => element("input", { type: "checkbox", name, onchange });
        this.dimmed = box("dim", () => this.change({ dimming: this.dimmed.checked ? 0.8 : 0 }));
        this.pairs = box("pairs", () => this.change({ pairs: this.pairs.checked }));
        return element(
            "div",
            { class: "view" },
            judged.label,
            button("First wrong pair", "Show the first wrong pair", () => this.showFirst()),
            element("label", {}, this.dimmed, " dim the others"),
            element("label", {}, this.pairs, " all pairs"),
            coloured.label,
            element("label", {}, "Cell ", cells, " m"),
            ...(recording.spheres ? [shape.label] : []),
        );
    }

    // Pictures have as many pixels as the screen.
    followScreen() {
        const dark = matchMedia("(prefers-color-scheme: dark)");
        const follow = () => this.change({ screen: dark.matches ? "dark" : "light" });
        dark.addEventListener("change", follow);
        follow();
        new ResizeObserver(() => this.redraw()).observe(this.canvas);
        // A query knows one density: when it is no longer that, another one waits for the next.
        const followDensity = () => {
            const query = matchMedia(`(resolution: ${devicePixelRatio}dppx)`);
            const changed = () => {
                this.redraw();
                followDensity();
            };
            query.addEventListener("change", changed, { once: true });
        };
        followDensity();
    }

    // All that WebGL2 held is gone; the browser gives another context, which begins with nothing.
    followLoss() {
        const { canvas, root } = this;
        canvas.addEventListener("webglcontextlost", (event) => {
            event.preventDefault(); // or it would not be restored
            this.setPlaying(false);
            this.isLost = true;
            root.dataset.state = "lost";
            this.words.textContent =
                "The browser has taken WebGL2 back. The picture returns when it gives it again; " +
                "if it does not, load the page again.";
        });
        canvas.addEventListener("webglcontextrestored", () => {
            this.isLost = false;
            this.words.textContent = "";
            this.drawing = new Drawing(this.gl, this.recording);
            this.show(this.frame);
            root.dataset.state = "ready";
        });
    }

    change(look) {
        Object.assign(this.look, look);
        this.setPairs();
        this.redraw();
    }

    chooseColouring(index) {
        const colouring = COLOURINGS[index % COLOURINGS.length];
        this.colouring.value = colouring;
        this.change({ colouring });
    }

    step(by) {
        this.show(Math.min(this.recording.frames - 1, Math.max(0, this.frame + by)));
    }

    judge(name) {
        this.broadphase = this.recording.broadphases.find((each) => each.name === name);
        this.words.textContent = "";
        this.show(this.frame);
    }

    show(frame) {
        this.frame = frame;
        this.numbers = this.recording.numbersOf(this.broadphase, frame);
        this.wrong = this.recording.wrongPairs(this.broadphase, frame);
        this.drawing.setFrame(this.numbers, this.wrong);
        this.linesOf = undefined;
        this.setPairs();
        this.slider.value = String(frame);
        this.tell();
        this.redraw();
    }

    // Only where they are to be seen, and once a frame.
    setPairs() {
        if (this.look.pairs && this.numbers && this.linesOf !== this.numbers) {
            this.linesOf = this.numbers;
            this.drawing.setPairs(this.recording.pairsOf(this.broadphase, this.frame));
        }
    }

    tell() {
        const { broadphase, frame, recording } = this;
        const [missing, extra] = [broadphase.missing[frame], broadphase.extra[frame]];
        const { pairsInAll, pairs, pairsListed } = recording.tracks[broadphase.track];
        const [inAll, here, listed] = [pairsInAll[frame], pairs[frame], pairsListed[frame]];
        const when = (isSo, text) => (isSo ? text : "");
        const drawn = this.wrong.length;
        this.number.textContent = `frame ${frame} of 0 to ${recording.frames - 1}`;
        this.counts.textContent =
            `${thousands(inAll)} pairs overlap` +
            when(here < inAll, `, ${thousands(here)} of them between those drawn`) +
            when(listed < here, ", too many to be drawn") +
            `; of ${broadphase.name}'s, ${thousands(missing)} are missing and ${thousands(extra)} extra` +
            when(drawn < missing + extra, ` (${thousands(drawn)} of them drawn)`) +
            ".";
        Object.assign(this.root.dataset, {
            frame,
            frames: recording.frames,
            pairs: inAll,
            broadphase: broadphase.name,
            missing,
            extra,
            drawn,
        });
    }

    // Once for all changes until the next picture of the screen.
    redraw() {
        this.asked ??= requestAnimationFrame(() => {
            this.asked = undefined;
            this.draw();
        });
    }

    draw() {
        const { canvas, look, recording } = this;
        look.pixels = Math.min(devicePixelRatio, 2);
        const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((each) =>
            Math.round(each * look.pixels),
        );
        if (width === 0 || height === 0 || this.isLost) {
            return; // the tab is hidden, or there is nothing to draw with
        }
        if (canvas.width !== width || canvas.height !== height) {
            Object.assign(canvas, { width, height });
        }
        const { both } = this.drawing.draw(look);
        this.chart.draw(this.broadphase, this.frame, recording.frames);
        this.legend.replaceChildren(...legendOf(look, recording));
        const first = this.wrong.slice(0, 1).flatMap(({ a, b }) => [a, b]);
        const marks = first.map((place) =>
            placeInPicture(both, recording.box(this.numbers, place).centre, width, height),
        );
        Object.assign(this.root.dataset, {
            colouring: look.colouring,
            lines: look.pairs ? this.drawing.allLines.count : 0,
            marks: JSON.stringify(marks),
            draws: ++this.draws,
        });
    }

    showFirst() {
        const { first, name, wrong } = this.broadphase;
        if (!first) {
            const others = `The wrong pairs of ${name} are of others than those drawn.`;
            this.words.textContent = wrong > 0 ? others : `No pair of ${name} is wrong in the recorded frames.`;
            return;
        }
        this.setPlaying(false);
        this.dimmed.checked = true;
        this.look.dimming = 0.8;
        this.show(first.frame);
        const [a, b] = first.places.map((place) => this.recording.box(this.numbers, place));
        const middle = scaled(plus(a.centre, b.centre), 0.5);
        const small = Math.min(Math.max(...a.edges), Math.max(...b.edges));
        const apart = Math.hypot(...minus(a.centre, b.centre));
        this.camera.lookAt(middle, Math.min(this.outline.radius, 4 * small + 2 * apart));
        this.words.textContent = `Frame ${first.frame}, ${name}: ${first.words}`;
    }

    togglePlaying() {
        this.setPlaying(!this.playing && !this.isLost);
    }

    setPlaying(playing) {
        this.playing = playing;
        this.play.textContent = playing ? "\u23f8" : "\u25b6";
        this.play.setAttribute("aria-label", playing ? "Pause" : "Play");
        this.root.dataset.playing = playing;
        clearTimeout(this.timer);
        if (playing) {
            this.timer = setTimeout(() => {
                this.show((this.frame + 1) % this.recording.frames);
                this.setPlaying(!document.hidden && this.canvas.clientWidth > 0);
            }, 1000 / this.framesASecond);
        }
    }
}

function startReplay(root) {
    const label = "The recorded objects; arrow keys turn the camera, plus and minus zoom";
    const canvas = element("canvas", { class: "replay", tabindex: 0, role: "img", "aria-label": label });
    const fail = (state, why) => {
        root.dataset.state = state;
        root.append(element("p", {}, why));
    };
    // Kept after it was shown, so that it can be saved, and read by whoever checks it.
    const kept = { alpha: false, antialias: true, preserveDrawingBuffer: true };
    const gl = canvas.getContext("webgl2", kept);
    if (!gl) {
        const why = "this browser has no WebGL2, or it is turned off. What was wrong in its frames is in the table.";
        fail("without WebGL2", `The recording cannot be replayed here: ${why}`);
        return;
    }
    try {
        const json = JSON.parse(root.querySelector("script").textContent);
        new Replay(root, gl, canvas, new Recording(json));
    } catch (error) {
        fail("failed", `The recording could not be replayed: ${error.message}`);
    }
}

for (const root of document.querySelectorAll("div.replay")) {
    const panel = root.closest("[role=tabpanel]");
    panel.addEventListener("tabshown", () => startReplay(root), { once: true });
}
