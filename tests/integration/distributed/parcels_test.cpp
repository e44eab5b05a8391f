// SPDX-License-Identifier: Zlib

// Parcels that no rank has sent: each is refused by a sentence, and none is believed.

#include <tests/integration/distributed/rank_world.hpp>

#include <cstring>
#include <string>

namespace hashphase::test {
namespace {

std::vector<std::byte> bytesOf(const Parcel& parcel) {
    return {parcel.bytes.begin(), parcel.bytes.end()};
}

/// Two ranks, of which the second one is handed whatever a test likes.
class Parcels : public testing::Test {
protected:
    static RankGridConfig withPayload() {
        RankGridConfig config;
        config.payloadBytes = 4;
        return config;
    }

    Parcels() {
        for (std::uint64_t i = 0; i < 20; ++i) {
            const auto x = 0.3F * static_cast<float>(i);
            sender_.add(GlobalId{i}, makeBox<float>(x, 0, 0, x + 1, 1, 1));
        }
        pack();
    }

    void pack() {
        const auto parcels = sender_.pack();
        ASSERT_EQ(1U, parcels.size());
        bytes_ = bytesOf(parcels[0]);
        receiver_.pack();
    }

    /// What the receiver says of the bytes; empty where it takes them.
    std::string complaint(const std::vector<std::byte>& bytes) {
        RankGrid<float> receiver(1, partition_, withPayload());
        receiver.pack();
        const Parcel parcel{0, bytes};
        try {
            receiver.finish(std::span(&parcel, 1));
        } catch (const RankError& error) {
            return error.what();
        }
        return "";
    }

    Partition<float> partition_{std::vector<Cut<float>>{{3, 0}}};
    RankGrid<float> sender_{0, partition_, withPayload()};
    RankGrid<float> receiver_{1, partition_, withPayload()};
    std::vector<std::byte> bytes_;
};

TEST_F(Parcels, AreTakenAsTheyWereSent) {
    EXPECT_EQ("", complaint(bytes_));
}

TEST_F(Parcels, ThatLieAboutTheirLengthAreRefused) {
    auto longer = bytes_;
    longer.push_back(std::byte{0});
    EXPECT_NE(std::string::npos, complaint(longer).find("The parcel from rank 0 had "));
    auto lying = longer;
    const std::uint64_t size = lying.size();
    std::memcpy(lying.data() + 4, &size, sizeof(size));
    EXPECT_NE(std::string::npos, complaint(lying).find("has 1 bytes after its last entry"));
    std::uint32_t count = 1'000'000;
    lying = bytes_;
    std::memcpy(lying.data() + 20, &count, sizeof(count));
    EXPECT_NE(std::string::npos, complaint(lying).find("ends within its entry"));
}

TEST_F(Parcels, ThatEndEarlyAreRefused) {
    for (std::size_t size = 0; size < bytes_.size(); ++size) {
        EXPECT_NE("",
                  complaint({bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(size)}))
            << size;
    }
}

TEST_F(Parcels, OfAnotherFrameAreRefused) {
    std::uint64_t frame = 7;
    std::memcpy(bytes_.data() + 12, &frame, sizeof(frame));
    EXPECT_EQ(
        "The parcel from rank 0 is of frame 7, but this is frame 0. Call pack() and finish() "
        "equally often on all ranks.",
        complaint(bytes_));
}

TEST_F(Parcels, WithAnyByteChangedAreRefusedOrTakenAndNeverCrash) {
    std::size_t refused = 0;
    for (std::size_t at = 0; at < bytes_.size(); ++at) {
        for (const unsigned bits : {1U, 0x80U, 0xffU}) {
            auto changed = bytes_;
            changed[at] ^= static_cast<std::byte>(bits);
            refused += complaint(changed).empty() ? 0 : 1;
        }
    }
    EXPECT_GT(refused, 3 * 24U);  // the head, at least, and all kinds
}

TEST_F(Parcels, AboutObjectsThatAreNotThereAreRefused) {
    // The second parcel is about ghosts that the first one has brought.
    const Parcel first{0, bytes_};
    receiver_.finish(std::span(&first, 1));
    sender_.finish({});
    for (std::uint64_t i = 0; i < 20; ++i) {
        const ProxyId id = sender_.find(GlobalId{i});
        if (sender_.isOwned(id)) {
            const Aabb<float>& box = sender_.grid().box(id);
            sender_.move(id, Aabb<float>(box.min(), box.max().array() + 0.1F));
        }
    }
    pack();
    EXPECT_NE(std::string::npos, complaint(bytes_).find("frame"));
    std::uint64_t frame = 0;
    std::memcpy(bytes_.data() + 12, &frame, sizeof(frame));
    EXPECT_NE(std::string::npos, complaint(bytes_).find("which is not a ghost of that rank here."));
}

TEST_F(Parcels, OfOneIdOnTwoRanksAreRefused) {
    RankGrid<float> receiver(1, partition_, withPayload());
    receiver.add(GlobalId{19}, makeBox<float>(4, 0, 0, 5, 1, 1));
    receiver.pack();
    const Parcel parcel{0, bytes_};
    try {
        receiver.finish(std::span(&parcel, 1));
        FAIL() << "took both";
    } catch (const RankError& error) {
        EXPECT_EQ(std::string("The global id 19 names two objects, one on rank 1 and one on rank "
                              "0. Give each object an id of its own."),
                  error.what());
    }
}

}  // namespace
}  // namespace hashphase::test
