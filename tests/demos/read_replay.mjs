// SPDX-License-Identifier: Zlib
//
// node read_replay.mjs <recording.json>
//
// Reads a recording with the script that pages read it with. Prints as JSON, frame by frame, the numbers of all
// objects and the pairs; the steps of the ground, if there is one; and the index of the worst broadphase. Frames are
// asked for from the last to the first and with few of them kept, which is harder.

import { readFileSync } from "node:fs";

const script = new URL("../../demos/replay/replay_data.js", import.meta.url);
const code = readFileSync(script, "utf8").replace(/MOST_BYTES_KEPT = \S+;/, "MOST_BYTES_KEPT = 9000;");
const { Recording } = new Function(`${code}; return { Recording };`)();
const recording = new Recording(JSON.parse(readFileSync(process.argv[2], "utf8")));
const [broadphase] = recording.broadphases;
const frames = [];
for (let frame = recording.frames - 1; frame >= 0; --frame) {
    const [numbers, pairs] = [recording.numbersOf(broadphase, frame), recording.pairsOf(broadphase, frame)];
    frames.unshift({ numbers: [...numbers], pairs: [...pairs] });
}
console.log(
    JSON.stringify({
        every: recording.tracks[0].every,
        frames,
        steps: [...(recording.ground?.steps ?? [])],
        worst: recording.broadphases.indexOf(recording.worst()),
    }),
);
