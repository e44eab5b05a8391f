// SPDX-License-Identifier: Zlib

// Kernel part: who is within a radius of whom. See kernels.inl.
//
// The agents of a cell, or of a few in a row, have the same candidates: all who are in the cells
// around. These are copied
// side by side, and each of the agents is compared with all of them, 64 at a time, with no branch in
// between; what is found is a bit for each candidate. Counting, listing, and counting by group all
// read these bits.

/// Candidates of which one word of hits tells.
constexpr std::uint32_t kWord = 64;

/// Columns are copied by so many entries.
constexpr std::uint32_t kCopied = kColumnPadding;

/// Agents that are compared before what they found is read.
constexpr std::uint32_t kAgentsAtOnce = 16;

/// Cells along a row, from firstX to lastX inclusive.
struct CellSegment {
    std::uint32_t firstX;
    std::uint32_t lastX;
    std::uint32_t y;
    std::uint32_t z;
};

/// Cells along an axis, wrapped around.
struct CellWindow {
    std::uint32_t first;
    std::uint32_t count;
};

inline CellWindow windowAround(std::uint32_t first, std::uint32_t last, std::uint32_t extent,
                               std::uint32_t reach) {
    const std::uint32_t count = last - first + 2 * reach + 1;
    if (extent <= count) {
        return {0, extent};
    }
    return {first < reach ? first + extent - reach : first - reach, count};
}

inline std::uint32_t wrapped(std::uint32_t cell, std::uint32_t extent) {
    return cell < extent ? cell : cell - extent;
}

template <class Number>
void copyNumbers(Number* to, const Number* from) {
    std::memcpy(to, from, kCopied * sizeof(Number));
}

/// At most: five rows an axis, and two runs a row.
constexpr std::uint32_t kMostRunsAround = 50;

// Sets `runs` to those of the cells around a segment that are not empty; returns how many.
template <class Scalar>
std::uint32_t runsAround(const RadiusView<Scalar>& view, const CellSegment& segment, Run* runs,
                         KernelCost& cost) {
    const std::uint32_t* extent = view.extent;
    const CellWindow windows[] = {
        windowAround(segment.firstX, segment.lastX, extent[0], view.reach),
        windowAround(segment.y, segment.y, extent[1], view.reach),
        windowAround(segment.z, segment.z, extent[2], view.reach)};
    const std::uint32_t first = windows[0].first;
    const std::uint32_t last = first + windows[0].count;
    std::uint32_t count = 0;
    for (std::uint32_t z = 0; z < windows[2].count; ++z) {
        const std::uint32_t layer = wrapped(windows[2].first + z, extent[2]) * extent[1];
        for (std::uint32_t y = 0; y < windows[1].count; ++y) {
            const std::uint32_t row = layer + wrapped(windows[1].first + y, extent[1]);
            const std::uint32_t* starts = view.cellStart + std::size_t{row} * extent[0];
            runs[count] = {starts[first], starts[lowest(last, extent[0])]};
            count += runs[count].first < runs[count].last ? 1 : 0;
            if (last > extent[0]) {
                runs[count] = {starts[0], starts[last - extent[0]]};
                count += runs[count].first < runs[count].last ? 1 : 0;
            }
        }
    }
    cost.rowsVisited += windows[1].count * windows[2].count;
    return count;
}

// Copies the positions of the candidates of a segment's agents, of which `agent` is the first one, and
// calls copy(to, from) for each kCopied of them that stood side by side.
template <class Scalar, class Copy>
void gatherTile(const RadiusView<Scalar>& view, const CellSegment& segment, std::uint32_t agent,
                RadiusTile<Scalar>& tile, KernelCost& cost, const Copy& copy) {
    Run runs[kMostRunsAround];
    const std::uint32_t runCount = runsAround(view, segment, runs, cost);
    std::uint32_t total = 0;
    std::uint32_t longest = 0;
    std::uint32_t farthest = 0;
    for (std::uint32_t i = 0; i < runCount; ++i) {
        const std::uint32_t count = runs[i].last - runs[i].first;
        total += count;
        longest = count < longest ? longest : count;
        farthest = runs[i].first < farthest ? farthest : runs[i].first;
    }
    // As many of every run, and what is too many is overwritten by the next one: branches between
    // runs of slightly different lengths could not be predicted.
    const std::uint32_t end = view.cellStart[view.extent[0] * view.extent[1] * view.extent[2]];
    const bool isEven = longest * runCount < 2 * total && farthest + longest <= end;
    if (total + longest > tile.capacity) {
        tile.grow(tile, total + longest);
    }
    const Scalar* const from[] = {view.columns[0], view.columns[1], view.columns[2]};
    Scalar* const to[] = {tile.columns[0], tile.columns[1], tile.columns[2]};
    const bool hasThird = view.axisCount > 2;
    std::size_t next = 0;
    for (std::uint32_t i = 0; i < runCount; ++i) {
        const std::size_t first = runs[i].first;
        const std::size_t count = runs[i].last - first;
        if (agent - runs[i].first < count) {
            tile.own = static_cast<std::uint32_t>(next) + (agent - runs[i].first);
        }
        const std::size_t copied = isEven ? longest : count;
        for (std::size_t k = 0; k < copied; k += kCopied) {
            copyNumbers(to[0] + next + k, from[0] + first + k);
            copyNumbers(to[1] + next + k, from[1] + first + k);
            if (hasThird) {
                copyNumbers(to[2] + next + k, from[2] + first + k);
            }
            copy(next + k, first + k);
        }
        next += count;
    }
    tile.count = total;
    tile.wordCount = (total + kWord - 1) / kWord;
    constexpr Scalar kNaN = std::numeric_limits<Scalar>::quiet_NaN();
    for (std::uint32_t k = 0; k < kWord; ++k) {
        to[0][total + k] = kNaN;  // within no distance
    }
}

// Writes the hits of each of the agents: tile.wordCount words for one after the other.
template <class Scalar, int kAxes, bool kIsScaled>
void searchTile(const RadiusView<Scalar>& view, const RadiusTile<Scalar>& tile, std::uint32_t first,
                std::uint32_t last) {
    using Pack = WidePack<Scalar>;
    const auto most = Pack::broadcast(view.mostSquared);
    const auto scale = Pack::broadcast(view.scale);
    std::uint64_t* hits = tile.hits;
    for (std::uint32_t agent = first; agent < last; ++agent) {
        typename Pack::Numbers own[kAxes];
        for (int axis = 0; axis < kAxes; ++axis) {
            own[axis] = Pack::broadcast(view.columns[axis][agent]);
        }
        for (std::uint32_t word = 0; word < tile.wordCount; ++word) {
            std::uint64_t mask = 0;
            for (std::uint32_t bit = 0; bit < kWord; bit += Pack::kWidth) {
                typename Pack::Numbers sum;
                for (int axis = 0; axis < kAxes; ++axis) {
                    auto way =
                        Pack::minus(Pack::load(tile.columns[axis] + kWord * word + bit), own[axis]);
                    if constexpr (kIsScaled) {
                        way = Pack::times(way, scale);
                    }
                    const auto square = Pack::times(way, way);
                    sum = axis == 0 ? square : Pack::plus(sum, square);
                }
                mask |= std::uint64_t{Pack::bits(Pack::lessEqual(sum, most))} << bit;
            }
            *hits++ = mask;
        }
    }
}

template <class Scalar>
using SearchTile = void (*)(const RadiusView<Scalar>& view, const RadiusTile<Scalar>& tile,
                            std::uint32_t first, std::uint32_t last);

template <class Scalar>
SearchTile<Scalar> searchFor(const RadiusView<Scalar>& view) {
    if (view.scale != 1) {
        return &searchTile<Scalar, 3, true>;
    }
    return view.axisCount == 2 ? &searchTile<Scalar, 2, false> : &searchTile<Scalar, 3, false>;
}

// The last cell that begins at or before the agent: its own.
template <class Scalar>
std::uint32_t cellOfAgent(const RadiusView<Scalar>& view, std::uint32_t agent) {
    Run cells{0, view.extent[0] * view.extent[1] * view.extent[2]};
    while (cells.last - cells.first > 1) {
        const std::uint32_t middle = cells.first + (cells.last - cells.first) / 2;
        (view.cellStart[middle] <= agent ? cells.first : cells.last) = middle;
    }
    return cells.first;
}

// Where agents are few, those of several cells of a row share their candidates, while these are no
// more than one word tells of, to go by the row.
template <class Scalar>
CellSegment segmentFrom(const RadiusView<Scalar>& view, std::uint32_t cell) {
    const std::uint32_t end = view.extent[0];
    const std::uint32_t row = cell / end;
    const std::uint32_t first = cell % end;
    const auto rowsAlong = [&](int axis) { return lowest(2 * view.reach + 1, view.extent[axis]); };
    const std::uint32_t most = kWord / (rowsAlong(1) * rowsAlong(2));
    const std::uint32_t* starts = view.cellStart + std::size_t{row} * end;
    const std::uint32_t begin = starts[first < view.reach ? 0 : first - view.reach];
    std::uint32_t last = first;
    // A segment whose window is all of the row would read it from its beginning, others from before
    // their first cell: the order of what is found must not depend on where parts begin.
    while (last + 1 < end && last + 2 - first + 2 * view.reach + 1 < end &&
           starts[lowest(last + view.reach + 2, end)] - begin <= most) {
        ++last;
    }
    return {first, last, row % view.extent[1], row / view.extent[1]};
}

// For each segment calls copy() as gatherTile() does, then begin(), then use(agent, hits) for its
// agents in order; the agent itself is not among the hits.
template <class Scalar, class Copy, class Begin, class Use>
void searchWithin(const RadiusView<Scalar>& view, std::uint32_t first, std::uint32_t last,
                  RadiusTile<Scalar>& tile, KernelCost& cost, const Copy& copy, const Begin& begin,
                  const Use& use) {
    const SearchTile<Scalar> search = searchFor(view);
    std::uint32_t agent = first;
    for (std::uint32_t cell = cellOfAgent(view, first); agent < last; ++cell) {
        if (view.cellStart[cell + 1] <= agent) {
            continue;
        }
        const CellSegment segment = segmentFrom(view, cell);
        cell += segment.lastX - segment.firstX;
        const std::uint32_t end = lowest(view.cellStart[cell + 1], last);
        gatherTile(view, segment, agent, tile, cost, copy);
        cost.boxesTested += std::uint64_t{tile.count} * (end - agent);
        begin();
        while (agent < end) {
            const std::uint32_t batch = lowest(agent + kAgentsAtOnce, end);
            search(view, tile, agent, batch);
            std::uint64_t* hits = tile.hits;
            for (; agent < batch; ++agent, ++tile.own, hits += tile.wordCount) {
                hits[tile.own / kWord] &= ~(std::uint64_t{1} << (tile.own % kWord));
                use(agent, hits);
            }
        }
    }
}

template <class Scalar>
std::uint64_t countWithin(const RadiusView<Scalar>& view, std::uint32_t first, std::uint32_t last,
                          RadiusTile<Scalar>& tile, std::uint32_t* counts, KernelCost& cost) {
    std::uint64_t found = 0;
    const auto count = [&](std::uint32_t agent, const std::uint64_t* hits) {
        std::uint32_t sum = 0;
        for (std::uint32_t word = 0; word < tile.wordCount; ++word) {
            sum += bitCount(hits[word]);
        }
        counts[agent] = sum;
        found += sum;
    };
    searchWithin(
        view, first, last, tile, cost, [](std::size_t, std::size_t) {}, [] {}, count);
    return found;
}

template <class Scalar>
std::uint64_t countGroupsWithin(const RadiusView<Scalar>& view, std::uint32_t first,
                                std::uint32_t last, RadiusTile<Scalar>& tile,
                                const std::uint8_t* groups, std::uint32_t groupCount,
                                std::uint32_t* counts, KernelCost& cost) {
    std::uint64_t found = 0;
    const auto copy = [&](std::size_t to, std::size_t from) {
        copyNumbers(tile.groups + to, groups + from);
    };
    // Which candidates are in which group: for each group one word after the other.
    const auto note = [&] {
        std::uint64_t* members = tile.members;
        for (std::uint32_t group = 0; group < groupCount; ++group) {
            for (std::uint32_t word = 0; word < tile.wordCount; ++word) {
                *members++ = equalBytes(tile.groups + std::size_t{kWord} * word,
                                        static_cast<std::uint8_t>(group));
            }
        }
    };
    const auto count = [&](std::uint32_t agent, const std::uint64_t* hits) {
        std::uint32_t* const sums = counts + std::size_t{agent} * groupCount;
        const std::uint64_t* members = tile.members;
        const std::uint32_t wordCount = tile.wordCount;
        std::uint64_t all = 0;
        for (std::uint32_t group = 0; group < groupCount; ++group) {
            std::uint32_t sum = 0;
            for (std::uint32_t word = 0; word < wordCount; ++word) {
                sum += bitCount(hits[word] & *members++);
            }
            sums[group] = sum;
            all += sum;
        }
        found += all;
    };
    searchWithin(view, first, last, tile, cost, copy, note, count);
    return found;
}

template <class Scalar>
std::uint64_t listWithin(const RadiusView<Scalar>& view, std::uint32_t first, std::uint32_t last,
                         RadiusTile<Scalar>& tile, const RadiusVisitor& visitor, KernelCost& cost) {
    std::uint64_t found = 0;
    const auto list = [&](std::uint32_t agent, const std::uint64_t* hits) {
        std::uint32_t* next = tile.found;
        for (std::uint32_t word = 0; word < tile.wordCount; ++word) {
            next = writeHits(hits[word], tile.numbers + kWord * word, next);
        }
        const auto count = static_cast<std::size_t>(next - tile.found);
        visitor.visit(visitor.owner, agent, tile.found, count);
        found += count;
    };
    const auto copy = [&](std::size_t to, std::size_t from) {
        copyNumbers(tile.numbers + to, view.numbers + from);
    };
    searchWithin(
        view, first, last, tile, cost, copy, [] {}, list);
    return found;
}
