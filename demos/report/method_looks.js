// SPDX-License-Identifier: Zlib
//
// The look of each method: the same on all pages, in drawings in files (draw), and in the replay.

// A name, or its beginning, with its colour (--series-0 and so on, of page.css) and its shape. The longest
// beginning counts. Blue and sky blue are ours, vermilion and orange Bullet's, purple the paper's; green and grey are
// for methods of several programs. The shape belongs to the whole name; series whose names go on have others.
const METHOD_LOOKS = {
    // Broadphases, by the names of the command line and by their classes.
    hash: [0, "circle"],
    hashphase: [0, "circle"],
    dbvt: [1, "square"],
    "dbvt-deferred": [4, "diamond"],
    "axis-sweep": [2, "triangle-up"],
    simple: [6, "cross"],
    btDbvtBroadphase: [1, "square"],
    "btDbvtBroadphase, deferred": [4, "diamond"],
    "btDbvtBroadphase, exact boxes": [4, "triangle-down"],
    bt32BitAxisSweep3: [2, "triangle-up"],
    btSimpleBroadphase: [6, "cross"],
    // The paper.
    "un-optimized": [6, "cross"],
    "brute force": [6, "cross"],
    "hashphase, automatic cells": [0, "circle"],
    paper: [3, "diamond"],
    "paper's grid": [3, "diamond"],
    // P1: sweeps.
    "Sweep::automatic": [0, "circle"],
    "Sweep::line": [5, "square"],
    "Sweep::box": [2, "triangle-up"],
    "discrete (Sweep::none)": [6, "cross"],
    "thick line of cells, tested": [3, "triangle-up"],
    "paper: box of cells": [3, "square"],
    "paper: line of cells": [3, "triangle-down"],
    "btDbvtBroadphase, discrete": [4, "cross"],
    "btDbvtBroadphase, united": [1, "triangle-down"],
    "btDbvtBroadphase, united, tested": [1, "diamond"],
    "Bullet's bodies, no CCD": [4, "triangle-up"],
    "Bullet's bodies, CCD": [4, "circle"],
    // P2: cell sizes.
    "automatic levels": [0, "circle"],
    levels: [5, "square"],
    "one grid, all cells (paper)": [3, "diamond"],
    "one grid, corner cells (paper)": [3, "triangle-down"],
    // P3: neighbours.
    "RarestColour, all at once": [0, "circle"],
    "RarestColour, every 2 frames": [0, "square"],
    "RarestColour, every 4 frames": [0, "triangle-up"],
    "RarestColour, every 8 frames": [0, "cross"],
    "RadiusSearch, listed": [5, "circle"],
    findWithin: [2, "circle"],
    "cells and boxes": [5, "square"],
    estimateWithin: [0, "diamond"],
    "cells, counted": [6, "cross"],
    "first 4 found": [2, "triangle-up"],
    "first 16 found": [2, "triangle-down"],
    "cells, as printed (paper)": [3, "diamond"],
    "btDbvtBroadphase, then distance": [1, "cross"],
    // P4: culling.
    "paper: two corners": [3, "diamond"],
    "paper: flat cells, six planes": [3, "cross"],
    "cells with heights, six planes": [6, "triangle-up"],
    "cells, then objects, six planes": [6, "square"],
    "GroundFootprint at the ground": [2, "circle"],
    "GroundFootprint up to the tallest": [2, "diamond"],
    "ConvexRegion by planes": [5, "circle"],
    "ConvexRegion exact": [5, "square"],
    Culler: [0, "circle"],
    "Culler, margin 4 m": [0, "triangle-up"],
    "Culler, fixed cells": [0, "triangle-down"],
    "btDbvt::collideKDOP": [1, "square"],
    // P5: rays.
    "paper: point on the plane": [3, "diamond"],
    "2D raster": [6, "square"],
    "DDA, accumulated": [2, "triangle-up"],
    "DDA, multiplied": [2, "cross"],
    "DDA, conservative": [5, "triangle-down"],
    "Grid::visit(RayRegion)": [0, "circle"],
    "Grid::visit(RayRegion), closest": [0, "diamond"],
    "btDbvtBroadphase::rayTest": [1, "square"],
    "btDbvtBroadphase::rayTest, btRayAabb": [4, "diamond"],
    // P6: far from the origin.
    float: [5, "square"],
    "float, rounded outward": [0, "circle"],
    "float positions": [6, "cross"],
    "integer cell + local float": [2, "diamond"],
    double: [0, "triangle-up"],
    "btDbvtBroadphase, float": [1, "square"],
    "Bullet in float, btDbvtBroadphase": [1, "square"],
    "Bullet in float, hashphase": [0, "circle"],
    "Bullet in float, hashphase, origin shifted": [2, "diamond"],
    // P9: terrain.
    "paper: height + r": [3, "diamond"],
    "height + r / n_y": [6, "square"],
    "Terrain, one by one": [5, "circle"],
    "Terrain, all at once": [0, "circle"],
    "Terrain, all at once, fixed cells": [2, "diamond"],
    "Bullet: ray at mesh, + r": [1, "square"],
    "Bullet: ray at mesh, + r / n_y": [1, "triangle-up"],
    "Bullet: ray at heightfield, + r": [4, "triangle-down"],
    "Bullet: sphere swept down": [4, "cross"],
    // P10: updates.
    "moved only": [0, "circle"],
    "all filed again": [5, "square"],
    "fat by ": [2],
    "every ": [6],
    "wiped and hashed again (paper)": [3, "diamond"],
};

// The colour of the method, and the shape where the name is whole; undefined of a method that the table lacks.
function fixedLook(name) {
    const beginnings = Object.keys(METHOD_LOOKS).filter((each) => name.startsWith(each));
    if (beginnings.length === 0) {
        return undefined;
    }
    const longest = beginnings.reduce((one, other) => (other.length > one.length ? other : one));
    const [colour, shape] = METHOD_LOOKS[longest];
    return { colour, shape: longest === name ? shape : undefined };
}
