// SPDX-License-Identifier: Zlib
//
// Replays a recording in a canvas, once its tab is shown: on the broadphase that the recording opens on, and the
// first frame with a wrong pair of it, or else the first frame.
//
// Data attributes of the replay's element hold what is shown, too: state (ready; lost while the browser has stopped
// WebGL2), playing, frame, frames, pairs (that overlap), lines (pairs drawn as lines), ground (drawn; hidden; none if
// the scene has no ground), colouring, broadphase, missing, extra, drawn (wrong pairs in the picture), marks (the two
// ends of the first of them in the picture, from its lower left [px]), draws.

class Replay {
    constructor(root, contents, gl, recording) {
        this.root = root;
        this.part = (place) => root.querySelector(place);
        this.recording = recording;
        this.frame = 0;
        this.framesASecond = 10;
        this.broadphase = recording.broadphases[recording.opensOn];
        this.gl = gl;
        this.canvas = gl.canvas;
        this.drawing = new Drawing(gl, recording);
        this.outline = recording.outline(recording.numbersOf(this.broadphase, 0));
        const { centre, radius, heights } = this.outline;
        this.camera = new OrbitCamera(centre, radius);
        this.look = {
            camera: this.camera,
            colouring: "cell",
            // The shown broadphase's, or else that of the first with cells.
            cellSize:
                [this.broadphase, ...recording.broadphases].find((each) => each.cellSize)?.cellSize ??
                Number((recording.typicalEdge * 8).toPrecision(2)),
            heights: [heights.low, Math.max(heights.high, heights.low + 1e-3)],
            groundEdge: Math.max(radius, 10 * recording.typicalEdge),
            spheres: recording.spheres,
            ground: Boolean(recording.ground),
            pairs: false,
            dimming: 0,
            screen: "light",
            pixels: 1,
        };
        this.draws = 0;
        root.append(...contents.childNodes);
        this.words = this.part(".words");
        this.fillControls();
        this.followControls();
        this.followKeys();
        this.followScreen();
        this.followLoss();
        this.show(this.broadphase.first?.frame ?? 0);
        root.dataset.state = "ready";
    }

    // With what depends on the recording.
    fillControls() {
        const { recording } = this;
        const { broadphases, frames, spheres, ground } = recording;
        this.control("frame").max = frames - 1;
        this.control("broadphase").append(...broadphases.map(({ name }) => new Option(name)));
        this.control("broadphase").value = this.broadphase.name;
        this.control("cellSize").value = Number(this.look.cellSize.toPrecision(4));
        if (!spheres) {
            this.control("shape").parentElement.remove();
        }
        if (!ground) {
            this.control("ground").parentElement.remove();
        }
        this.part(".faults").append(...faultsOfAll(recording));
        this.part("[data-act=showFirst]").hidden = !recording.worst().first;
    }

    control(name) {
        return this.part(`[name=${name}]`);
    }

    followControls() {
        const { camera } = this;
        const steers = (act) => () => {
            act();
            this.redraw();
        };
        const acts = {
            turnLeft: steers(() => camera.orbit(-0.3, 0)),
            turnRight: steers(() => camera.orbit(0.3, 0)),
            closer: steers(() => camera.zoom(0.7)),
            farther: steers(() => camera.zoom(1 / 0.7)),
            lookDown: steers(() => camera.lookDown()),
            reset: steers(() => camera.reset()),
            play: () => this.togglePlaying(),
            before: () => this.step(-1),
            after: () => this.step(1),
            showFirst: () => this.showFirst(),
        };
        for (const button of this.root.querySelectorAll("[data-act]")) {
            button.addEventListener("click", acts[button.dataset.act]);
        }
        const values = {
            frame: (frame) => this.show(Number(frame)),
            speed: (framesASecond) => (this.framesASecond = Number(framesASecond)),
            broadphase: (name) => this.judge(name),
            dim: (isOn) => this.change({ dimming: isOn ? 0.8 : 0 }),
            ground: (isOn) => this.change({ ground: isOn }),
            pairs: (isOn) => this.change({ pairs: isOn }),
            colouring: (colouring) => this.change({ colouring }),
            cellSize: (size) => Number(size) > 0 && this.change({ cellSize: Number(size) }),
            shape: (name) => this.change({ spheres: name === "spheres" }),
        };
        for (const [name, act] of Object.entries(values)) {
            const control = this.control(name);
            const isBox = control?.type === "checkbox";
            control?.addEventListener("input", () => act(isBox ? control.checked : control.value));
        }
        steerByPointer(this.canvas, camera, () => this.redraw());
        const keys = {
            ArrowLeft: steers(() => camera.orbit(-0.1, 0)),
            ArrowRight: steers(() => camera.orbit(0.1, 0)),
            ArrowUp: steers(() => camera.orbit(0, 0.1)),
            ArrowDown: steers(() => camera.orbit(0, -0.1)),
            "+": steers(() => camera.zoom(0.8)),
            "-": steers(() => camera.zoom(1.25)),
        };
        this.canvas.addEventListener("keydown", (event) => {
            if (keys[event.key]) {
                event.preventDefault();
                keys[event.key]();
            }
        });
    }

    // While the tab is shown, whatever has the focus; but a control keeps the keys that it uses itself.
    followKeys() {
        const keys = {
            " ": () => this.togglePlaying(),
            ",": () => this.step(-1),
            ".": () => this.step(1),
            Home: () => this.show(0),
            End: () => this.show(this.recording.frames - 1),
            w: () => this.showFirst(),
            t: () => this.control("ground")?.click(),
            p: () => this.control("pairs").click(),
            d: () => this.control("dim").click(),
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

    // Pictures have as many pixels as the screen.
    followScreen() {
        const dark = matchMedia("(prefers-color-scheme: dark)");
        const follow = () => this.change({ screen: dark.matches ? "dark" : "light" });
        dark.addEventListener("change", follow);
        follow();
        new ResizeObserver(() => this.redraw()).observe(this.canvas);
        // A query is about one density: after a change another query waits for the next change.
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

    // The browser drops everything that WebGL2 held, and may give an empty context later.
    followLoss() {
        const { canvas, root } = this;
        canvas.addEventListener("webglcontextlost", (event) => {
            event.preventDefault(); // or it would not be restored
            this.setPlaying(false);
            this.isLost = true;
            root.dataset.state = "lost";
            this.words.textContent =
                "The browser stopped WebGL2. The picture returns when the browser restores it. " +
                "If it does not, reload the page.";
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
        this.control("colouring").value = colouring;
        this.change({ colouring });
    }

    step(by) {
        this.show(Math.min(this.recording.frames - 1, Math.max(0, this.frame + by)));
    }

    // Stays in the frame if it shows a wrong pair of that broadphase; else goes to the first frame that does, if any.
    judge(name) {
        this.broadphase = this.recording.broadphases.find((each) => each.name === name);
        this.words.textContent = "";
        const { first } = this.broadphase;
        const isSeen = this.recording.wrongPairs(this.broadphase, this.frame).length > 0;
        this.show(isSeen || !first ? this.frame : first.frame);
    }

    show(frame) {
        this.frame = frame;
        this.numbers = this.recording.numbersOf(this.broadphase, frame);
        this.wrong = this.recording.wrongPairs(this.broadphase, frame);
        this.drawing.setFrame(this.numbers, this.wrong);
        this.linesOf = undefined;
        this.setPairs();
        this.control("frame").value = frame;
        this.tell();
        this.redraw();
    }

    // If they are to be seen, and once a frame.
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
        showMethod(this.part(".method"), broadphase.name);
        this.part("output").textContent = `frame ${frame} (0 to ${recording.frames - 1})`;
        const verdict =
            missing + extra === 0
                ? `${broadphase.name} lists exactly these`
                : `${broadphase.name}: ${faultsOf(missing, extra)}`;
        this.part(".counts").textContent =
            `Overlapping pairs: ${thousands(inAll)}` +
            when(here < inAll, `, ${thousands(here)} of them between recorded objects`) +
            when(listed < here, ", too many to draw") +
            `. ${verdict}` +
            when(drawn < missing + extra, ` (${thousands(drawn)} drawn)`) +
            ".";
        const { frames } = recording;
        const { name } = broadphase;
        const told = { frame, frames, pairs: inAll, broadphase: name, missing, extra, drawn };
        Object.assign(this.root.dataset, told);
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
        const chart = this.part(".wrong-chart");
        drawWrongPairs(chart, this.broadphase, this.frame, recording.frames);
        this.part(".legend").replaceChildren(...legendOf(look, recording));
        const first = this.wrong.slice(0, 1).flatMap(({ a, b }) => [a, b]);
        const marks = first.map((place) =>
            placeInPicture(both, recording.box(this.numbers, place).centre, width, height),
        );
        Object.assign(this.root.dataset, {
            colouring: look.colouring,
            ground: look.ground ? "drawn" : recording.ground ? "hidden" : "none",
            lines: look.pairs ? this.drawing.allLines.count : 0,
            marks: JSON.stringify(marks),
            draws: ++this.draws,
        });
    }

    // Of the chosen broadphase, or else of the worst.
    showFirst() {
        const { recording } = this;
        const shown = this.broadphase.first ? this.broadphase : recording.worst();
        const { first, name } = shown;
        if (!first) {
            this.words.textContent = recording.broadphases.some(isWrong)
                ? "Every wrong pair has an object that is not recorded."
                : NONE_WRONG;
            return;
        }
        this.broadphase = shown;
        this.control("broadphase").value = name;
        this.setPlaying(false);
        this.control("dim").checked = true;
        this.look.dimming = 0.8;
        this.show(first.frame);
        const [a, b] = first.places.map((place) => recording.box(this.numbers, place));
        const middle = a.centre.map((each, axis) => (each + b.centre[axis]) / 2);
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
        const button = this.part("[data-act=play]");
        button.textContent = playing ? "\u23f8" : "\u25b6";
        button.setAttribute("aria-label", playing ? "Pause" : "Play");
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
    const contents = element("div", "");
    contents.innerHTML = REPLAY_HTML;
    const fail = (state, why) => {
        root.dataset.state = state;
        root.append(element("p", "", why));
    };
    // Kept after it was shown, so that it can be saved, and read by whoever checks it.
    const kept = { alpha: false, antialias: true, preserveDrawingBuffer: true };
    const gl = contents.querySelector("canvas.replay").getContext("webgl2", kept);
    if (!gl) {
        const why = "This browser has no WebGL2, or WebGL2 is turned off.";
        fail("without WebGL2", `${why} The replay needs it. The table lists the wrong pairs.`);
        return;
    }
    try {
        const json = JSON.parse(root.querySelector("script").textContent);
        new Replay(root, contents, gl, new Recording(json));
    } catch (error) {
        fail("failed", `The replay failed: ${error.message}`);
    }
}

for (const root of document.querySelectorAll("div.replay")) {
    const panel = root.closest("[role=tabpanel]");
    panel.addEventListener("tabshown", () => startReplay(root), { once: true });
}
