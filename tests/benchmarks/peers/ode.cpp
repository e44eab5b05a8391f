// SPDX-License-Identifier: Zlib

// The Open Dynamics Engine: its multi-resolution hash space, and its sweep-and-prune space.

#include <tests/benchmarks/peers/peers.hpp>

#include <ode/ode.h>

namespace hashphase::benchmarks {
namespace {

using demos::PairKey;

struct GeomData {
    Aabb<float> box;
    std::uint32_t object;
};

GeomData& dataOf(dGeomID geom) {
    return *static_cast<GeomData*>(dGeomGetClassData(geom));
}

void readBox(dGeomID geom, dReal bounds[6]) {
    const Aabb<float>& box = dataOf(geom).box;
    for (int axis = 0; axis < 3; ++axis) {
        bounds[2 * axis] = box.min()[axis];
        bounds[2 * axis + 1] = box.max()[axis];
    }
}

// Our own class of geoms: one that has a box and nothing else, so that ODE sees exactly ours.
int boxClass() {
    static const int number = [] {
        dInitODE2(0);
        dGeomClass definition{};
        definition.bytes = sizeof(GeomData);
        definition.collider = [](int) -> dColliderFn* { return nullptr; };
        definition.aabb = readBox;
        return dCreateGeomClass(&definition);
    }();
    return number;
}

class OdeContestant : public Contestant {
public:
    // The space is made after the library is.
    explicit OdeContestant(dSpaceID (*makeSpace)()) : class_(boxClass()), space_(makeSpace()) {}
    ~OdeContestant() override { dSpaceDestroy(space_); }

    void fill(const FrameBoxes& frame) override {
        for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
            dGeomID geom = dCreateGeom(class_);
            dataOf(geom) = {frame.boxes[i], static_cast<std::uint32_t>(i)};
            const demos::CollisionFilter filter = frame.filterOf(i);
            // ODE lets two meet when one accepts the other, Bullet when both do. That is the same
            // where, as in all scenes here, masks accept each other or neither.
            dGeomSetCategoryBits(geom, static_cast<unsigned int>(filter.group));
            dGeomSetCollideBits(geom, static_cast<unsigned int>(filter.mask));
            dSpaceAdd(space_, geom);
            geoms_.push_back(geom);
        }
    }

    void setAll(const FrameBoxes& frame) override {
        for (std::size_t i = 0; i < geoms_.size(); ++i) {
            GeomData& data = dataOf(geoms_[i]);
            if (!isSameBits(data.box, frame.boxes[i])) {
                data.box = frame.boxes[i];
                const Vector3<float> centre = data.box.center();
                dGeomSetPosition(geoms_[i], centre.x(), centre.y(), centre.z());
            }
        }
    }

    void findPairs() override {
        pairs_.clear();
        dSpaceCollide(space_, &pairs_, [](void* data, dGeomID a, dGeomID b) {
            static_cast<std::vector<PairKey>*>(data)->push_back(
                demos::pairKey(dataOf(a).object, dataOf(b).object));
        });
    }

    void listPairs(std::vector<PairKey>& pairs) override { pairs = pairs_; }

private:
    int class_;
    dSpaceID space_;
    std::vector<dGeomID> geoms_;
    std::vector<PairKey> pairs_;
};

ContestantKind odeKind(const char* name, const char* title, const char* description,
                       std::size_t upTo, dSpaceID (*makeSpace)()) {
    return {.name = name,
            .title = title,
            .description = description,
            .package = HASHPHASE_BENCHMARKS_ODE_PACKAGE,
            .upTo = upTo,
            .make = [makeSpace](const demos::BroadphaseNeeds&) {
                return std::make_unique<OdeContestant>(makeSpace);
            }};
}

}  // namespace

std::vector<ContestantKind> odeKinds() {
    return {odeKind("ode-hash", "dHashSpaceCreate", "ODE's hash space (up to 3,000 objects)", 3'000,
                    [] { return dHashSpaceCreate(nullptr); }),
            odeKind("ode-sap", "dSweepAndPruneSpaceCreate",
                    "ODE's sweep and prune (up to 30,000 objects)", 30'000,
                    [] { return dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XZY); })};
}

}  // namespace hashphase::benchmarks
