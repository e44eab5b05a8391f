// SPDX-License-Identifier: Zlib
#include <demos/stability/subject.hpp>

#include <algorithm>
#include <iterator>
#include <map>

namespace hashphase::demos {
namespace {

template <class Scalar>
class GridSubject final : public Subject<Scalar> {
public:
    explicit GridSubject(const SubjectNeeds<Scalar>& needs)
        : grid_(needs.grid), pairs_(grid_), ids_(needs.objects) {}

    void create(std::uint32_t object, const Aabb<Scalar>& box) override {
        const ProxyId id = grid_.add(box);
        ids_[object] = id;
        objects_.resize(std::max<std::size_t>(objects_.size(), id.index + 1));
        objects_[id.index] = object;
    }
    void move(std::uint32_t object, const Aabb<Scalar>& box) override {
        grid_.move(ids_[object], box);
    }
    void destroy(std::uint32_t object) override {
        removed_[ids_[object]] = object;
        grid_.remove(ids_[object]);
    }

    void findPairs() override {
        const PairChanges changes = pairs_.update();
        const std::size_t before = known_.size();
        Keys changed = keysOf(changes.born);
        const Keys died = keysOf(changes.died);
        changed.insert(changed.end(), died.begin(), died.end());
        std::sort(changed.begin(), changed.end());
        removed_.clear();
        Keys known;
        std::set_symmetric_difference(known_.begin(), known_.end(), changed.begin(), changed.end(),
                                      std::back_inserter(known));
        known_.swap(known);
        isConsistent_ &= known_.size() + changes.died.size() == before + changes.born.size();
    }
    void listPairs(Keys& pairs) const override { pairs = known_; }

    [[nodiscard]] Objects touching(const Aabb<Scalar>& region) const override {
        std::vector<ProxyId> found;
        CollectAll collector(found);
        grid_.visit(BoxRegion<Scalar>{region}, collector);
        Objects objects;
        for (const ProxyId id : found) {
            objects.push_back(objects_[id.index]);
        }
        return objects;
    }

    [[nodiscard]] const Grid<Scalar>* grid() const override { return &grid_; }
    [[nodiscard]] PairCost cost() const override { return pairs_.lastCost(); }
    [[nodiscard]] std::size_t memoryBytes() const override {
        return grid_.memoryBytes() + pairs_.memoryBytes();
    }

    [[nodiscard]] std::string validate() const override {
        if (!isConsistent_) {
            return "A pair began while it existed, or ended while it did not exist.";
        }
        std::vector<ProxyPair> collected;
        pairs_.collect(collected);
        if (keysOf(collected) != known_) {
            return "collect() does not list the pairs that have begun and not ended.";
        }
        const std::string text = grid_.validate();
        return text.empty() ? pairs_.validate() : text;
    }

private:
    [[nodiscard]] std::uint32_t objectOf(ProxyId id) const {
        return grid_.contains(id) ? objects_[id.index] : removed_.at(id);
    }
    [[nodiscard]] Keys keysOf(std::span<const ProxyPair> pairs) const {
        Keys keys;
        for (const ProxyPair& pair : pairs) {
            keys.push_back(pairKey(objectOf(pair.first), objectOf(pair.second)));
        }
        std::sort(keys.begin(), keys.end());
        return keys;
    }

    Grid<Scalar> grid_;
    Pairs<Scalar> pairs_;
    std::vector<ProxyId> ids_;                  // by object
    Objects objects_;                           // by the index of a proxy
    std::map<ProxyId, std::uint32_t> removed_;  // since the last update
    Keys known_;                                // by what was reported
    bool isConsistent_ = true;
};

}  // namespace

template <class Scalar>
std::unique_ptr<Subject<Scalar>> makeGridSubject(const SubjectNeeds<Scalar>& needs) {
    return std::make_unique<GridSubject<Scalar>>(needs);
}

template std::unique_ptr<Subject<float>> makeGridSubject(const SubjectNeeds<float>& needs);
template std::unique_ptr<Subject<double>> makeGridSubject(const SubjectNeeds<double>& needs);

}  // namespace hashphase::demos
