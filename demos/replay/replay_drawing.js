// SPDX-License-Identifier: Zlib
//
// Draws one frame of a recording with WebGL2.

// Of Okabe and Ito, "Color Universal Design", 2008, but for orange and vermilion, which mark wrong
// pairs; with steps of blue, green and purple, which people of any colour vision can tell apart.
const CELL_COLOURS = [
    "#0072b2",
    "#56b4e9",
    "#009e73",
    "#cc79a7",
    "#f0e442",
    "#7fc8b0",
    "#8a7fd0",
    "#b9bec4",
];
// Viridis, by Smith and van der Walt, at five places.
const HEIGHT_COLOURS = ["#440154", "#3b528b", "#21918c", "#5ec962", "#fde725"];
const OVERLAP_COLOURS = ["#c3ccd6", "#8db6dc", "#4f93cf", "#2a62b0", "#1a2f7a"];
const MISSING_COLOUR = "#e8102a";
const EXTRA_COLOUR = "#ff8c00";
const COLOURINGS = ["cell", "height", "overlaps"];

const SCREENS = {
    light: { top: "#b9d3ea", bottom: "#f6f3ec", dim: "#c9ced4", halo: "#ffffff", pair: "#1d2733" },
    dark: { top: "#0d1420", bottom: "#2b3442", dim: "#4a525d", halo: "#000000", pair: "#f2f5f8" },
};

const rgb = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
const allRgb = (hexes) => new Float32Array(hexes.flatMap(rgb));

class Program {
    constructor(gl, vertices, pixels) {
        this.gl = gl;
        this.program = gl.createProgram();
        for (const [type, source] of [
            [gl.VERTEX_SHADER, vertices],
            [gl.FRAGMENT_SHADER, pixels],
        ]) {
            const shader = gl.createShader(type);
            gl.shaderSource(shader, source);
            gl.compileShader(shader);
            gl.attachShader(this.program, shader);
        }
        gl.linkProgram(this.program);
        if (!gl.getProgramParameter(this.program, gl.LINK_STATUS)) {
            const logs = gl
                .getAttachedShaders(this.program)
                .map((each) => gl.getShaderInfoLog(each));
            throw new Error([gl.getProgramInfoLog(this.program), ...logs].join(" "));
        }
    }

    use(uniforms) {
        const { gl } = this;
        gl.useProgram(this.program);
        for (const [name, value] of Object.entries(uniforms)) {
            const at = gl.getUniformLocation(this.program, name);
            if (Number.isInteger(value) && name === "colouring") {
                gl.uniform1i(at, value);
            } else if (typeof value === "number") {
                gl.uniform1f(at, value);
            } else if (value.length === 16) {
                gl.uniformMatrix4fv(at, false, value);
            } else if (value.length === 2) {
                gl.uniform2fv(at, value);
            } else {
                gl.uniform3fv(at, value);
            }
        }
    }
}

// Rows of numbers that vertex shaders fetch, in texels of four. (Instances of six vertices each take
// 2.5 times as long where there is no GPU.)
class Texels {
    constructor(gl, inner, format, type) {
        Object.assign(this, { gl, inner, format, type });
        this.count = 0;
        this.texture = gl.createTexture();
        this.nothing = gl.createVertexArray(); // all comes from the texels
        gl.bindTexture(gl.TEXTURE_2D, this.texture);
        for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
            gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
        }
    }

    // Room for so many items of eight numbers each.
    static room(Numbers, count) {
        return new Numbers(Math.max(1, Math.ceil(count / ITEMS_A_ROW)) * ITEMS_A_ROW * 8);
    }

    set(numbers, count) {
        const { gl, inner, format, type } = this;
        this.count = count;
        const [width, height] = [2 * ITEMS_A_ROW, numbers.length / (8 * ITEMS_A_ROW)];
        gl.bindTexture(gl.TEXTURE_2D, this.texture);
        gl.texImage2D(gl.TEXTURE_2D, 0, inner, width, height, 0, format, type, numbers);
    }

    draw(vertices) {
        const { gl } = this;
        gl.bindVertexArray(this.nothing);
        gl.bindTexture(gl.TEXTURE_2D, this.texture);
        gl.drawArrays(gl.TRIANGLES, 0, vertices * this.count);
    }
}

// Boxes: their numbers as recorded, and their marks.
class Objects extends Texels {
    constructor(gl) {
        super(gl, gl.RGBA16UI, gl.RGBA_INTEGER, gl.UNSIGNED_SHORT);
    }

    setAll(numbers, marks) {
        const texels = Texels.room(Uint16Array, marks.length);
        for (let i = 0; i < marks.length; ++i) {
            const [from, to] = [i * NUMBERS_AN_OBJECT, i * 8];
            for (let axis = 0; axis < 3; ++axis) {
                texels[to + axis] = numbers[from + axis];
                texels[to + 4 + axis] = numbers[from + 3 + axis];
            }
            texels[to + 3] = numbers[from + 6];
            texels[to + 7] = marks[i];
        }
        this.set(texels, marks.length);
    }
}

// Pairs: lines from centre to centre, with a ring where they are marked.
class Lines extends Texels {
    constructor(gl) {
        super(gl, gl.RGBA32F, gl.RGBA, gl.FLOAT);
    }

    // `placesOf(i)`: the two objects of the i-th; `markOf(i)`: its mark.
    setAll(count, placesOf, markOf, numbers, extent) {
        const texels = Texels.room(Float32Array, count);
        for (let i = 0; i < count; ++i) {
            placesOf(i).forEach((place, end) => {
                for (let axis = 0; axis < 3; ++axis) {
                    const share = numbers[place * NUMBERS_AN_OBJECT + axis] / STEPS;
                    texels[8 * i + 4 * end + axis] = share * extent[axis];
                }
            });
            texels[8 * i + 3] = markOf(i);
        }
        this.set(texels, count);
    }
}

class Drawing {
    // `gl` is the canvas's context.
    constructor(gl, recording) {
        this.gl = gl;
        this.recording = recording;
        this.background = new Program(gl, BACKGROUND_VERTICES, BACKGROUND_PIXELS);
        this.bodies = [
            new Program(gl, BOX_VERTICES, BOX_PIXELS),
            new Program(gl, SPHERE_VERTICES, SPHERE_PIXELS),
        ];
        this.pairs = new Program(gl, PAIR_VERTICES, PAIR_PIXELS);
        this.all = new Objects(gl);
        this.wrong = new Objects(gl);
        this.nothing = gl.createVertexArray();
        this.allLines = new Lines(gl);
        this.wrongLines = new Lines(gl);
        gl.enable(gl.DEPTH_TEST);
        gl.depthFunc(gl.LEQUAL); // the background is as far as can be
        gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    }

    // The objects of a frame, and the wrong pairs that are to be seen.
    setFrame(numbers, wrongPairs) {
        this.numbers = numbers;
        const marks = new Uint8Array(this.recording.objects);
        for (const { a, b, isMissing } of wrongPairs) {
            for (const place of [a, b]) {
                marks[place] = Math.max(marks[place], isMissing ? 2 : 1);
            }
        }
        this.all.setAll(numbers, marks);
        const places = [...new Set(wrongPairs.flatMap(({ a, b }) => [a, b]))];
        const wrongNumbers = new Uint16Array(places.length * NUMBERS_AN_OBJECT);
        places.forEach((place, i) => {
            const at = place * NUMBERS_AN_OBJECT;
            wrongNumbers.set(numbers.subarray(at, at + NUMBERS_AN_OBJECT), i * NUMBERS_AN_OBJECT);
        });
        this.wrong.setAll(
            wrongNumbers,
            Uint8Array.from(places, (place) => marks[place]),
        );
        this.wrongLines.setAll(
            wrongPairs.length,
            (i) => [wrongPairs[i].a, wrongPairs[i].b],
            (i) => (wrongPairs[i].isMissing ? 2 : 1),
            numbers,
            this.recording.extent,
        );
    }

    // All pairs of the frame that was set last, two places each.
    setPairs(pairs) {
        this.allLines.setAll(
            pairs.length / 2,
            (i) => pairs.subarray(2 * i, 2 * i + 2),
            () => 0,
            this.numbers,
            this.recording.extent,
        );
    }

    // `look`: camera, colouring, cellSize, heights, groundEdge, spheres, pairs, dimming, screen, pixels.
    // Returns the camera's matrices.
    draw(look) {
        const { gl } = this;
        const { width, height } = gl.canvas;
        const screen = SCREENS[look.screen];
        const matrices = look.camera.view(width / height);
        gl.viewport(0, 0, width, height);
        gl.clear(gl.DEPTH_BUFFER_BIT);
        gl.depthMask(false);
        this.background.use({ top: rgb(screen.top), bottom: rgb(screen.bottom) });
        gl.bindVertexArray(this.nothing);
        gl.drawArrays(gl.TRIANGLES, 0, 3);
        gl.depthMask(true);
        this.drawBodies(look, screen, matrices);
        this.pairs.use({
            both: matrices.both,
            picture: [width, height],
            pixels: look.pixels,
            halo: rgb(screen.halo),
            pairColour: rgb(screen.pair),
            missingColour: rgb(MISSING_COLOUR),
            extraColour: rgb(EXTRA_COLOUR),
        });
        if (look.pairs) {
            this.allLines.draw(12);
        }
        this.wrongLines.draw(12);
        gl.disable(gl.BLEND);
        gl.enable(gl.DEPTH_TEST);
        return matrices;
    }

    // All of them; then those in wrong pairs once more, to shine through what hides them.
    drawBodies(look, screen, matrices) {
        const { gl, recording } = this;
        const index = look.spheres ? 1 : 0;
        const vertices = look.spheres ? 6 : 18;
        this.bodies[index].use({
            both: matrices.both,
            view: matrices.view,
            eye: matrices.eye,
            projection: matrices.projection,
            extent: recording.extent,
            low: recording.low,
            heights: look.heights,
            groundEdge: look.groundEdge,
            colouring: COLOURINGS.indexOf(look.colouring),
            cellSize: look.cellSize,
            cellColours: allRgb(CELL_COLOURS),
            heightColours: allRgb(HEIGHT_COLOURS),
            overlapColours: allRgb(OVERLAP_COLOURS),
            missingColour: rgb(MISSING_COLOUR),
            extraColour: rgb(EXTRA_COLOUR),
            dimColour: rgb(screen.dim),
            dimming: look.dimming,
            dimmingSingles: look.pairs ? Math.max(0.85, look.dimming) : look.dimming,
            opacity: 1,
        });
        gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
        this.all.draw(vertices);
        gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
        gl.disable(gl.DEPTH_TEST);
        gl.enable(gl.BLEND);
        this.bodies[index].use({ opacity: 0.4 });
        this.wrong.draw(vertices);
    }
}
