// SPDX-License-Identifier: Zlib
//
// Reads a recording as replay_recording.cpp wrote it.

const NUMBERS_AN_OBJECT = 7; // centre and edges along x, y, z in steps; how many others it overlaps
const STEPS = 65535;
const MOST_BYTES_KEPT = 128e6; // of decoded frames; those between are decoded again

function bytesOfBase64(text) {
    const letters = atob(text);
    const bytes = new Uint8Array(letters.length);
    for (let i = 0; i < letters.length; ++i) {
        bytes[i] = letters.charCodeAt(i);
    }
    return bytes;
}

// Little-endian, whatever the machine is.
function numbersOfBase64(text) {
    const bytes = bytesOfBase64(text);
    const view = new DataView(bytes.buffer);
    return Uint32Array.from({ length: bytes.length / 4 }, (_, i) => view.getUint32(4 * i, true));
}

// Reads a stream, from where it is, in bytes and in groups of seven bits.
class Reader {
    constructor(bytes, at) {
        Object.assign(this, { bytes, at });
    }

    byte() {
        return this.bytes[this.at++];
    }

    number() {
        let number = 0;
        let shift = 0;
        let byte;
        do {
            byte = this.byte();
            number |= (byte & 127) << shift;
            shift += 7;
        } while (byte > 127);
        return number >>> 0;
    }
}

// The numbers of all objects in the next frame: the stream that replay_track.hpp describes.
function nextBoxes(reader, last) {
    const now = last.slice();
    const end = now.length;
    for (let at = 0; at < end; at += NUMBERS_AN_OBJECT) {
        const changed = reader.byte();
        if (changed === 0) {
            at += reader.number() * NUMBERS_AN_OBJECT;
            continue;
        }
        for (let k = 0; k < NUMBERS_AN_OBJECT; ++k) {
            if (changed & (1 << k)) {
                const zigzag = reader.number();
                now[at + k] += (zigzag >>> 1) ^ -(zigzag & 1);
            }
        }
    }
    return now;
}

// The sorted pairs of the next frame, two places each: the stream that replay_track.hpp describes.
function nextPairs(reader, last, count) {
    const stay = new Uint8Array(last.length / 2).fill(1);
    let at = -1;
    for (let deaths = reader.number(); deaths > 0; --deaths) {
        at += reader.number() + 1;
        stay[at] = 0;
    }
    const now = new Uint32Array(2 * count);
    let end = 0;
    let from = 0;
    const takeThoseBefore = (a, b) => {
        while (from < stay.length && (last[2 * from] - a || last[2 * from + 1] - b) < 0) {
            if (stay[from]) {
                now[end++] = last[2 * from];
                now[end++] = last[2 * from + 1];
            }
            ++from;
        }
    };
    let [a, b] = [0, 0];
    for (let births = reader.number(); births > 0; --births) {
        const next = a + reader.number();
        b = (next === a ? b : next) + reader.number();
        a = next;
        takeThoseBefore(a, b);
        now[end++] = a;
        now[end++] = b;
    }
    takeThoseBefore(Infinity, 0);
    return now;
}

// The frames of a track, in any order: every so many of them are kept, in order to go on from there.
class Track {
    constructor(json, frames, objects) {
        Object.assign(this, json);
        this.boxBytes = bytesOfBase64(json.boxStream);
        this.pairBytes = bytesOfBase64(json.pairStream);
        const bytes = 14 * objects + 8 * Math.max(0, ...json.pairsListed);
        this.every = Math.ceil((frames * bytes) / MOST_BYTES_KEPT) || 1;
        const nothing = { boxes: new Uint16Array(objects * NUMBERS_AN_OBJECT), boxesAt: 0 };
        this.now = { frame: -1, ...nothing, pairs: new Uint32Array(0), pairsAt: 0 };
        this.kept = [this.now]; // that after whose frame comes the i-th times `every`
    }

    at(frame) {
        const place = Math.min(Math.floor((frame + 1) / this.every), this.kept.length - 1);
        if (this.now.frame > frame || this.now.frame < this.kept[place].frame) {
            this.now = this.kept[place];
        }
        while (this.now.frame < frame) {
            this.step();
        }
        return this.now;
    }

    step() {
        const frame = this.now.frame + 1;
        const ofBoxes = new Reader(this.boxBytes, this.now.boxesAt);
        const ofPairs = new Reader(this.pairBytes, this.now.pairsAt);
        const boxes = nextBoxes(ofBoxes, this.now.boxes);
        const pairs = nextPairs(ofPairs, this.now.pairs, this.pairsListed[frame]);
        this.now = { frame, boxes, boxesAt: ofBoxes.at, pairs, pairsAt: ofPairs.at };
        if (frame + 1 === this.kept.length * this.every) {
            this.kept.push(this.now);
        }
    }
}

// Where a broadphase's wrong pairs of each frame begin in its places.
function beginsOfFrames(broadphase) {
    let begin = 0;
    return broadphase.missingListed.map((missing, frame) => {
        const here = begin;
        begin += 2 * (missing + broadphase.extraListed[frame]);
        return here;
    });
}

const sumOf = (numbers) => numbers.reduce((sum, each) => sum + each, 0);

class Recording {
    constructor(json) {
        Object.assign(this, json);
        this.extent = this.high.map((high, axis) => high - this.low[axis]);
        this.tracks = json.tracks.map((track) => new Track(track, this.frames, this.objects));
        for (const broadphase of this.broadphases) {
            broadphase.places = numbersOfBase64(broadphase.places);
            broadphase.begins = beginsOfFrames(broadphase);
            broadphase.missingInAll = sumOf(broadphase.missing);
            broadphase.extraInAll = sumOf(broadphase.extra);
        }
        if (this.ground) {
            this.ground.steps = bytesOfBase64(this.ground.heights);
        }
    }

    // The broadphase that misses most pairs; of equals, the one that lists most extra pairs. Those with a wrong
    // pair between recorded objects come first.
    worst() {
        const faults = ({ first, missingInAll, extraInAll }) => [first ? 1 : 0, missingInAll, extraInAll];
        return this.broadphases.reduce((worst, each) => {
            const most = faults(worst);
            const differences = faults(each).map((count, i) => count - most[i]);
            return differences.find((difference) => difference !== 0) > 0 ? each : worst;
        });
    }

    // What all objects are like, as the broadphase sees them.
    numbersOf(broadphase, frame) {
        return this.tracks[broadphase.track].at(frame).boxes;
    }

    // Those that overlap, places of two objects each; none where there are too many.
    pairsOf(broadphase, frame) {
        return this.tracks[broadphase.track].at(frame).pairs;
    }

    // Those that are listed: places of two objects each, and whether the pair is missing.
    wrongPairs(broadphase, frame) {
        const missing = broadphase.missingListed[frame];
        const count = missing + broadphase.extraListed[frame];
        return Array.from({ length: count }, (_, i) => {
            const at = broadphase.begins[frame] + 2 * i;
            const [a, b] = broadphase.places.subarray(at, at + 2);
            return { a, b, isMissing: i < missing };
        });
    }

    // Relative to the low corner of the bounds [m].
    box(numbers, place) {
        const at = place * NUMBERS_AN_OBJECT;
        const metres = (k) => (numbers[at + k] / STEPS) * this.extent[k % 3];
        return { centre: [0, 1, 2].map(metres), edges: [3, 4, 5].map(metres) };
    }

    // Where nearly all objects are: middle, radius, and from where to where in height.
    outline(numbers) {
        const spread = [0, 1, 2].map((axis) => {
            const centre = (_, place) => this.box(numbers, place).centre[axis];
            const sorted = Float64Array.from({ length: this.objects }, centre).sort();
            const at = (share) => sorted[Math.round(share * (this.objects - 1))] ?? 0;
            return { low: at(0.01), high: at(0.99) };
        });
        const centre = spread.map(({ low, high }) => (low + high) / 2);
        const radius = Math.hypot(...spread.map(({ low, high }) => (high - low) / 2));
        return { centre, radius: Math.max(radius, 2 * this.typicalEdge), heights: spread[1] };
    }
}
