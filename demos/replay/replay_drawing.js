// SPDX-License-Identifier: Zlib
//
// Draws one frame of a recording with WebGL2.

// Of Okabe and Ito, "Color Universal Design", 2008, but for orange and vermilion, which mark wrong
// pairs; with steps of blue, green and purple, which people of any colour vision can tell apart.
const CELL_COLOURS =
    "#0072b2 #56b4e9 #009e73 #cc79a7 #f0e442 #7fc8b0 #8a7fd0 #b9bec4".split(" ");
// Viridis, by Smith and van der Walt, at five places.
const HEIGHT_COLOURS = ["#440154", "#3b528b", "#21918c", "#5ec962", "#fde725"];
const OVERLAP_COLOURS = ["#c3ccd6", "#8db6dc", "#4f93cf", "#2a62b0", "#1a2f7a"];
const MISSING_COLOUR = "#e8102a";
const EXTRA_COLOUR = "#ff8c00";
const COLOURINGS = ["cell", "height", "overlaps"];

const SCREENS = {
    light: {
        top: "#b9d3ea", bottom: "#f6f3ec", dim: "#c9ced4", halo: "#ffffff", pair: "#1d2733", ground: "#d6cfb8",
    },
    dark: {
        top: "#0d1420", bottom: "#2b3442", dim: "#4a525d", halo: "#000000", pair: "#f2f5f8", ground: "#4d5545",
    },
};

const rgb = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
const allRgb = (hexes) => new Float32Array(hexes.flatMap(rgb));

const ITEMS_A_ROW = 1024; // of textures that hold two texels an item
const GLSL = `#version 300 es
precision highp float;
precision highp int;
#define ITEMS_A_ROW ${ITEMS_A_ROW}
`;

// Of shaders in files, both in each: the vertices' where VERTEX is defined.
class Program {
    constructor(gl, ...files) {
        this.gl = gl;
        this.program = gl.createProgram();
        for (const type of [gl.VERTEX_SHADER, gl.FRAGMENT_SHADER]) {
            const define = type === gl.VERTEX_SHADER ? "#define VERTEX\n" : "";
            const shader = gl.createShader(type);
            gl.shaderSource(shader, GLSL + define + files.join(""));
            gl.compileShader(shader);
            gl.attachShader(this.program, shader);
        }
        gl.linkProgram(this.program);
        if (!gl.getProgramParameter(this.program, gl.LINK_STATUS)) {
            const shaders = gl.getAttachedShaders(this.program);
            const logs = shaders.map((each) => gl.getShaderInfoLog(each));
            throw new Error([gl.getProgramInfoLog(this.program), ...logs].join(" "));
        }
    }

    use(uniforms) {
        const { gl } = this;
        gl.useProgram(this.program);
        for (const [name, value] of Object.entries(uniforms)) {
            const at = gl.getUniformLocation(this.program, name);
            if (name === "colouring") {
                gl.uniform1i(at, value);
            } else if (value.length === 16) {
                gl.uniformMatrix4fv(at, false, value);
            } else if (value.length === 2) {
                gl.uniform2fv(at, value);
            } else if (value.length) {
                gl.uniform3fv(at, value);
            } else {
                gl.uniform1f(at, value);
            }
        }
    }
}

// A bound one, of texels that shaders fetch.
function makeTexture(gl) {
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
        gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
    }
    return texture;
}

// Items of eight numbers each that vertex shaders fetch, in two texels. (Instances of six vertices each take
// 2.5 times as long where there is no GPU.)
class Items {
    constructor(gl, Numbers, inner, format, type) {
        Object.assign(this, { gl, Numbers, inner, format, type });
        this.count = 0;
        this.texture = makeTexture(gl);
        this.nothing = gl.createVertexArray(); // all comes from the texels
    }

    // `fill(texels, at, i)` sets the numbers of the i-th, from `at` on.
    set(count, fill) {
        const { gl, inner, format, type } = this;
        this.count = count;
        const rows = Math.max(1, Math.ceil(count / ITEMS_A_ROW));
        const texels = new this.Numbers(rows * ITEMS_A_ROW * 8);
        for (let i = 0; i < count; ++i) {
            fill(texels, 8 * i, i);
        }
        gl.bindTexture(gl.TEXTURE_2D, this.texture);
        gl.texImage2D(gl.TEXTURE_2D, 0, inner, 2 * ITEMS_A_ROW, rows, 0, format, type, texels);
    }

    draw(vertices) {
        const { gl } = this;
        gl.bindVertexArray(this.nothing);
        gl.bindTexture(gl.TEXTURE_2D, this.texture);
        gl.drawArrays(gl.TRIANGLES, 0, vertices * this.count);
    }
}

// The ground: squares of a lattice, two triangles each, seen from above. From below it hides nothing.
class Ground {
    constructor(gl, { columns, rows, lowest, highest, steps }, { low, extent }) {
        this.gl = gl;
        this.vertices = 6 * (columns - 1) * (rows - 1);
        this.place = { extent, heightRange: [lowest - low[1], highest - low[1]] };
        this.program = new Program(gl, LIGHT_GLSL, GROUND_GLSL);
        this.nothing = gl.createVertexArray();
        this.texture = makeTexture(gl);
        gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
        gl.texImage2D(gl.TEXTURE_2D, 0, gl.R8, columns, rows, 0, gl.RED, gl.UNSIGNED_BYTE, steps);
    }

    draw({ both }, groundColour) {
        const { gl } = this;
        this.program.use({ both, ...this.place, groundColour });
        gl.bindVertexArray(this.nothing);
        gl.bindTexture(gl.TEXTURE_2D, this.texture);
        gl.enable(gl.CULL_FACE);
        gl.drawArrays(gl.TRIANGLES, 0, this.vertices);
        gl.disable(gl.CULL_FACE);
    }
}

class Drawing {
    // `gl` is the canvas's context.
    constructor(gl, recording) {
        this.gl = gl;
        this.recording = recording;
        this.background = new Program(gl, BACKGROUND_GLSL);
        this.bodies = [
            new Program(gl, LIGHT_GLSL, OBJECTS_GLSL, BOXES_GLSL),
            new Program(gl, LIGHT_GLSL, OBJECTS_GLSL, SPHERES_GLSL),
        ];
        this.ground = recording.ground && new Ground(gl, recording.ground, recording);
        this.pairs = new Program(gl, PAIRS_GLSL);
        const objects = () =>
            new Items(gl, Uint16Array, gl.RGBA16UI, gl.RGBA_INTEGER, gl.UNSIGNED_SHORT);
        const lines = () => new Items(gl, Float32Array, gl.RGBA32F, gl.RGBA, gl.FLOAT);
        [this.all, this.wrong] = [objects(), objects()];
        [this.allLines, this.wrongLines] = [lines(), lines()];
        this.nothing = gl.createVertexArray();
        gl.enable(gl.DEPTH_TEST);
        gl.depthFunc(gl.LEQUAL); // the background is as far as can be
        gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    }

    // The objects of a frame, as recorded, and the wrong pairs that are to be seen.
    setFrame(numbers, wrongPairs) {
        this.numbers = numbers;
        const marks = new Uint8Array(this.recording.objects);
        for (const { a, b, isMissing } of wrongPairs) {
            for (const place of [a, b]) {
                marks[place] = Math.max(marks[place], isMissing ? 2 : 1);
            }
        }
        const fill = (texels, to, place) => {
            const from = place * NUMBERS_AN_OBJECT;
            for (let axis = 0; axis < 3; ++axis) {
                texels[to + axis] = numbers[from + axis];
                texels[to + 4 + axis] = numbers[from + 3 + axis];
            }
            texels[to + 3] = numbers[from + 6];
            texels[to + 7] = marks[place];
        };
        this.all.set(marks.length, fill);
        const places = [...new Set(wrongPairs.flatMap(({ a, b }) => [a, b]))];
        this.wrong.set(places.length, (texels, to, i) => fill(texels, to, places[i]));
        this.setLines(this.wrongLines, wrongPairs.length, (i) => {
            const { a, b, isMissing } = wrongPairs[i];
            return [a, b, isMissing ? 2 : 1];
        });
    }

    // All pairs of the frame that was set last, two places each.
    setPairs(pairs) {
        this.setLines(this.allLines, pairs.length / 2, (i) => [pairs[2 * i], pairs[2 * i + 1], 0]);
    }

    // Lines from centre to centre, with a ring where they are marked. `pairOf(i)`: the i-th's two objects, and
    // its mark.
    setLines(lines, count, pairOf) {
        const { extent } = this.recording;
        lines.set(count, (texels, to, i) => {
            const pair = pairOf(i);
            for (let end = 0; end < 2; ++end) {
                for (let axis = 0; axis < 3; ++axis) {
                    const share = this.numbers[pair[end] * NUMBERS_AN_OBJECT + axis] / STEPS;
                    texels[to + 4 * end + axis] = share * extent[axis];
                }
            }
            texels[to + 3] = pair[2];
        });
    }

    // `look`: camera, colouring, cellSize, heights, groundEdge, spheres, ground, pairs, dimming, screen, pixels.
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
        if (look.ground) {
            this.ground.draw(matrices, rgb(screen.ground));
        }
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
        const program = this.bodies[look.spheres ? 1 : 0];
        const vertices = look.spheres ? 6 : 18;
        const { heights, groundEdge, cellSize, dimming } = look;
        program.use({
            ...matrices,
            extent: recording.extent,
            low: recording.low,
            heights,
            groundEdge,
            colouring: COLOURINGS.indexOf(look.colouring),
            cellSize,
            cellColours: allRgb(CELL_COLOURS),
            heightColours: allRgb(HEIGHT_COLOURS),
            overlapColours: allRgb(OVERLAP_COLOURS),
            missingColour: rgb(MISSING_COLOUR),
            extraColour: rgb(EXTRA_COLOUR),
            dimColour: rgb(screen.dim),
            dimming,
            dimmingSingles: look.pairs ? Math.max(0.85, dimming) : dimming,
            opacity: 1,
        });
        gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
        this.all.draw(vertices);
        gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
        gl.disable(gl.DEPTH_TEST);
        gl.enable(gl.BLEND);
        program.use({ opacity: 0.4 });
        this.wrong.draw(vertices);
    }
}
