// SPDX-License-Identifier: Zlib
#pragma once

#include <demos/console/program.hpp>

#include <string>
#include <vector>

namespace hashphase::demos {

/// `hashphase swarm`: spheres that wander, over the processes of an MPI program. With the arguments as typed
/// it starts itself by mpirun.
[[nodiscard]] Subcommand swarmCommand(const std::vector<std::string>& arguments);

/// The rank that the program which has started this one has given it, before MPI says so; 0 where none has.
[[nodiscard]] int rankByEnvironment() noexcept;

}  // namespace hashphase::demos
