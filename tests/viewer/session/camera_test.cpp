// SPDX-License-Identifier: Zlib

#include <demos/viewer/session/camera.hpp>
#include <demos/viewer/session/session.hpp>
#include <tests/viewer/session/stages.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>

namespace hashphase::demos {
namespace {

std::string poseLine(const Camera& camera) {
    std::ostringstream line;
    line.precision(9);
    line << "pose " << kCameraModes[static_cast<std::size_t>(camera.mode())];
    for (const float number : camera.state()) {
        line << ' ' << number;
    }
    return line.str();
}

/// Somebody goes on and on in one direction.
void goFar(Session& session, float sign) {
    const std::string number = sign < 0 ? "-1000000" : "1000000";
    for (const char* mode : {"camera top", "camera free"}) {
        session.run(mode);
        for (int i = 0; i < 1100; ++i) {
            session.run("move " + number + " " + number + " " + number);
            session.run(sign < 0 ? "turn -350 -80" : "turn 350 80");
        }
        for (int i = 0; i < 30; ++i) {
            session.run(sign < 0 ? "zoom 100" : "zoom 0.01");
        }
    }
    session.camera.setTarget(Vector3<float>::Constant(sign * 1e20F));
    session.camera.setMode(CameraMode::follow);
    for (int i = 0; i < 30; ++i) {
        session.run(sign < 0 ? "zoom 100" : "zoom 0.01");
    }
}

TEST(Camera, FliesAtFirstAndIsAsItWasAfterARestart) {
    Session session({.name = "wander", .file = {}, .objects = 20, .seed = 1}, 800, 600);
    EXPECT_EQ(session.camera.mode(), CameraMode::free);
    session.run("camera top");
    session.run("restart");
    EXPECT_EQ(session.camera.mode(), CameraMode::top);
}

TEST(Camera, StaysWhereAPoseCanPutIt) {
    for (const float sign : {1.0F, -1.0F}) {
        Session session({.name = "wander", .file = {}, .objects = 20, .seed = 1}, 800, 600);
        goFar(session, sign);
        const Camera::State far = session.camera.state();
        const std::string line = poseLine(session.camera);
        for (const float number : far) {
            EXPECT_TRUE(std::isfinite(number)) << line;
        }
        session.run("home");
        EXPECT_EQ(faultOf(session, line), "none");
        EXPECT_EQ(session.camera.state(), far) << line;
        for (const char* mode : {"camera top", "camera free"}) {
            session.run(mode);
            step(session, 1);
            EXPECT_TRUE(session.pose().eye.allFinite());
            EXPECT_TRUE(std::isfinite(session.pose().farPlane));
        }
    }
}

TEST(Camera, IsWhereItsStateSays) {
    const Camera::State state{1, 2, 3, 40, 0.1F, 6, 7, 8, 0.2F, 0.3F, 11, 12, 13, 140, 0.4F, -0.5F};
    Camera camera;
    const auto poseIn = [&](CameraMode mode) {
        camera.setState(mode, state);
        EXPECT_EQ(camera.state(), state);
        return camera.pose(1);
    };
    EXPECT_EQ(poseIn(CameraMode::top).eye, Vector3<float>(1, 42, 3));
    EXPECT_FLOAT_EQ(poseIn(CameraMode::top).yaw, 0.1F);
    EXPECT_EQ(poseIn(CameraMode::free).eye, Vector3<float>(6, 7, 8));
    EXPECT_FLOAT_EQ(poseIn(CameraMode::free).yaw, 0.2F);
    EXPECT_FLOAT_EQ(poseIn(CameraMode::free).pitch, 0.3F);
    const CameraPose following = poseIn(CameraMode::follow);
    EXPECT_NEAR((following.eye - Vector3<float>(11, 12, 13)).norm(), 140, 1e-3);
    EXPECT_FLOAT_EQ(following.yaw, 0.4F);
    EXPECT_FLOAT_EQ(following.pitch, -0.5F);
}

TEST(Camera, IsPutNowhereElse) {
    Session session({.name = "wander", .file = {}, .objects = 20, .seed = 1}, 800, 600);
    const Camera::State home = session.camera.state();
    for (std::size_t i = 0; i < home.size(); ++i) {
        for (const char* number : {"10000001", "-10000001", "nan"}) {
            std::string line = "pose free";
            for (std::size_t k = 0; k < home.size(); ++k) {
                line += k == i ? std::string(" ") + number : " " + std::to_string(home[k]);
            }
            EXPECT_NE(faultOf(session, line), "none") << line;
        }
    }
    EXPECT_EQ(session.camera.state(), home);
}

// --- Who is seen ---------------------------------------------------------------------------------

/// Whom the camera of now sees, asked of the grid.
std::size_t seenNow(const Session& session) {
    Culler<float> culler;
    culler.look(*session.stage->grid(),
                ConvexRegion<float>(cameraView(session.pose()).planes, Containment::touching,
                                    Touch::byPlanes));
    return culler.count();
}

/// Those that a picture shows.
std::size_t shown(const Session& session) {
    std::size_t count = 0;
    for (std::uint32_t index = 0; index < session.stage->indexLimit(); ++index) {
        count += session.stage->contains(index) && session.isVisible(index) ? 1 : 0;
    }
    return count;
}

Session crowd() {
    return Session({.name = "wander", .file = {}, .objects = 2000, .seed = 1}, 800, 600);
}

TEST(FrozenCulling, IsByTheCameraOfTheMomentAtWhichItWasFrozen) {
    Session session = crowd();
    session.run("eye 200 60 390 0 -25");
    session.run("freeze on");
    session.run("home");
    step(session, 5);
    Session other = crowd();
    other.run("eye 200 60 390 0 -25");
    step(other, 5);
    EXPECT_EQ(session.visibleCount(), seenNow(other));
    EXPECT_EQ(shown(session), seenNow(other));
    EXPECT_LT(shown(session), 1900U);
}

TEST(Culling, IsByTheCameraOfThePicture) {
    Session session = crowd();
    session.run("camera top");
    step(session, 1);
    EXPECT_EQ(session.visibleCount(), 2000U);
    session.run("effect culling off");
    session.run("effect culling on");
    EXPECT_EQ(session.visibleCount(), 2000U);
    session.run("eye 200 60 390 0 -25");
    const std::size_t seen = seenNow(session);
    EXPECT_LT(seen, 1900U);
    EXPECT_EQ(session.visibleCount(), seen);
    session.run("screenshot a.png");
    EXPECT_EQ(shown(session), seen);
}

TEST(FollowingCamera, LooksAtTheBodyAsSoonAsItFollows) {
    Session session = crowd();
    session.run("pose top 200 7 200 60 0 0 0 0 0 0 0 0 0 20 0 0");
    for (int x = 20; x < 800 && !session.card; x += 4) {
        session.pick({double(x), 300});
    }
    ASSERT_TRUE(session.card);
    const Vector3<float> before = session.card->body.centre;
    step(session, 60);
    const Vector3<float> centre = session.card->body.centre;
    EXPECT_GT((centre - before).norm(), 1);
    const float distance = session.camera.state()[13];
    session.run("camera follow");
    EXPECT_NEAR((session.pose().eye - centre).norm(), distance, 1e-3);
    session.run("home");
    EXPECT_NEAR((session.pose().eye - centre).norm(), session.camera.state()[13], 1e-3);
    session.run("turn 120 0");
    for (int frame = 0; frame < 20; ++frame) {
        step(session, 1);
        EXPECT_NEAR((session.pose().eye - session.card->body.centre).norm(),
                    session.camera.state()[13], 1e-3);
        EXPECT_EQ(shown(session), seenNow(session)) << frame;
        EXPECT_EQ(session.visibleCount(), seenNow(session)) << frame;
    }
}

}  // namespace
}  // namespace hashphase::demos
