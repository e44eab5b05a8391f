// SPDX-License-Identifier: Zlib
#include <integration/bullet/detail/joint_image.hpp>

#include <integration/bullet/detail/bullet_classes.hpp>

#include <BulletDynamics/ConstraintSolver/btConeTwistConstraint.h>
#include <BulletDynamics/ConstraintSolver/btGearConstraint.h>
#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpring2Constraint.h>
#include <BulletDynamics/ConstraintSolver/btGeneric6DofSpringConstraint.h>
#include <BulletDynamics/ConstraintSolver/btHingeConstraint.h>
#include <BulletDynamics/ConstraintSolver/btPoint2PointConstraint.h>
#include <BulletDynamics/ConstraintSolver/btSliderConstraint.h>

#include <algorithm>
#include <cstddef>

namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE {
namespace {

struct JointMembers : btTypedConstraint {
    /// Behind the last member of the base, which has all of a joint's pointers.
    static std::byte* endOfBase(btTypedConstraint& joint) {
        return reinterpret_cast<std::byte*>(&(joint.*(&JointMembers::m_jointFeedback)) + 1);
    }
};

/// 0 where it is unknown.
std::size_t sizeOf(btTypedConstraint& joint) {
    switch (joint.getConstraintType()) {
        case POINT2POINT_CONSTRAINT_TYPE:
            return sizeof(btPoint2PointConstraint);
        case HINGE_CONSTRAINT_TYPE:
            return countsAngles(joint) ? sizeof(btHingeAccumulatedAngleConstraint)
                                       : sizeof(btHingeConstraint);
        case CONETWIST_CONSTRAINT_TYPE:
            return sizeof(btConeTwistConstraint);
        case D6_CONSTRAINT_TYPE:
            return sizeof(btGeneric6DofConstraint);
        case SLIDER_CONSTRAINT_TYPE:
            return sizeof(btSliderConstraint);
        case D6_SPRING_CONSTRAINT_TYPE:
            return sizeof(btGeneric6DofSpringConstraint);
        case GEAR_CONSTRAINT_TYPE:
            return sizeof(btGearConstraint);
        case FIXED_CONSTRAINT_TYPE:
        case D6_SPRING_2_CONSTRAINT_TYPE:
            return sizeof(btGeneric6DofSpring2Constraint);
        default:
            return 0;
    }
}

/// What the joint's own class adds to the base: numbers alone, of which Bullet tells but some.
struct OwnBytes {
    std::byte* begin;
    std::size_t count;

    explicit OwnBytes(btTypedConstraint& joint) : begin(JointMembers::endOfBase(joint)) {
        const auto offset = begin - reinterpret_cast<std::byte*>(&joint);
        count = sizeOf(joint) - static_cast<std::size_t>(offset);
    }
};

}  // namespace

bool isKnown(const btTypedConstraint& joint) noexcept {
    return sizeOf(const_cast<btTypedConstraint&>(joint)) != 0;
}

void saveJoint(btTypedConstraint& joint, ByteWriter& to) {
    to.write(joint.internalGetAppliedImpulse());
    to.write(joint.getBreakingImpulseThreshold());
    to.write(joint.isEnabled());
    to.write(joint.getOverrideNumSolverIterations());
    const OwnBytes own(joint);
    to.write(own.begin, own.count);
}

void restoreJoint(btTypedConstraint& joint, ByteReader& from) {
    joint.internalSetAppliedImpulse(from.read<btScalar>());
    joint.setBreakingImpulseThreshold(from.read<btScalar>());
    joint.setEnabled(from.read<bool>());
    // So many that a stranger's bytes cannot make a step endless.
    constexpr int kMostIterations = 1 << 16;
    joint.setOverrideNumSolverIterations(std::min(from.read<int>(), kMostIterations));
    const OwnBytes own(joint);
    from.read(own.begin, own.count);
}

}  // namespace hashphase::detail::inline HASHPHASE_BULLET_NAMESPACE
