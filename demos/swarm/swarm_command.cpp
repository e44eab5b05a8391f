// SPDX-License-Identifier: Zlib
#include <demos/swarm/swarm_command.hpp>

#include <demos/console/format.hpp>
#include <demos/console/options.hpp>
#include <demos/console/progress.hpp>
#include <demos/console/result_file.hpp>
#include <demos/report/provenance.hpp>
#include <demos/report/report_text.hpp>
#include <demos/swarm/scaling_plan.hpp>
#include <demos/swarm/swarm_files.hpp>
#include <demos/swarm/swarm_report.hpp>
#include <demos/swarm/swarm_run.hpp>
#include <demos/system/interruption.hpp>
#include <demos/system/other_programs.hpp>
#include <demos/system/process.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <ostream>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

namespace hashphase::demos {
namespace {

struct SwarmOptions {
    std::string scene{swarmKinds().front().name};
    std::uint64_t objects = 1'000'000;
    std::uint32_t frames = 100;
    std::uint32_t ranks = 0;  // 0: as many as there are
    std::uint64_t seed = 1;
    double rebalanceAbove = 1.1;
    double patience = 120;  // [s]
    std::string vtkFolder;  // empty: none
    std::uint32_t vtkEvery = 10;
    std::string csvFile;
    bool unchecked = false;
    bool quiet = false;
    bool list = false;
    bool plan = false;
};

void declareSwarm(CLI::App& app, SwarmOptions& options) {
    app.add_option("--scene", options.scene, "population of spheres; --list prints all")
        ->type_name("NAME")
        ->capture_default_str();
    app.add_option("--objects", options.objects, "number of spheres")
        ->transform(wholeFrom(10, 4'000'000'000U))
        ->capture_default_str();
    app.add_option("--frames", options.frames, "number of frames")
        ->transform(wholeFrom(1, 1'000'000))
        ->capture_default_str();
    app.add_option("--ranks", options.ranks,
                   "number of ranks (MPI processes) to start with mpirun (default: the ranks that "
                   "mpirun has started, or one). After Ctrl-C, mpirun's exit status is 1")
        ->transform(wholeFrom(1, 100'000));
    app.add_option("--seed", options.seed, "seed of the spheres")->transform(seedUpTo());
    app.add_option(
           "--rebalance-above", options.rebalanceAbove,
           "divide space again when the load of a rank, its estimated work for pairs, exceeds this "
           "many times the mean load")
        ->check(CLI::Range(1.0, 1e6).description("1 to 1,000,000"))
        ->capture_default_str();
    app.add_option("--patience", options.patience,
                   "give up when a rank does not answer for this many seconds")
        ->transform(positiveSeconds())
        ->capture_default_str();
    addFolderToWrite(app, "--vtk", options.vtkFolder,
                     "write files for ParaView to this folder: open swarm.pvd and regions.pvd");
    app.add_option("--vtk-every", options.vtkEvery, "frames from one file for ParaView to the next")
        ->transform(wholeFrom(1, 1'000'000))
        ->capture_default_str();
    addFileToWrite(app, "--csv", options.csvFile, "write a row per frame and rank to this file");
    app.add_flag("--unchecked", options.unchecked,
                 "do not also run in one process to compare pairs and times");
    app.add_flag("--plan", options.plan,
                 "print what 64 to 16,384 ranks would send each other, and exit");
    app.add_flag("--quiet", options.quiet, "print no progress");
    app.add_flag("--list", options.list, "print the populations, and exit");
}

SwarmKind chosenKind(const std::string& name) {
    std::vector<std::string> known;
    for (const SwarmKindName& each : swarmKinds()) {
        if (each.name == name) {
            return each.kind;
        }
        known.emplace_back(each.name);
    }
    throw InputError(unknownNameSentence("population", name, known));
}

void printList(std::ostream& out) {
    out << "Populations:\n";
    for (const SwarmKindName& each : swarmKinds()) {
        out << "  " << each.name << std::string(13 - each.name.size(), ' ') << each.description
            << '\n';
    }
}

int printPlan(const SwarmOptions& options, Console& console) {
    const SwarmKind kind = chosenKind(options.scene);
    const MachineModel model;
    const std::vector<PlanSize> sizes = plannedSizes();
    std::vector<PlannedFrame> frames;
    {
        Progress progress(console.err, progressStyle(console, options.quiet), "plan", sizes.size());
        for (const PlanSize& size : sizes) {
            throwIfInterrupted();
            frames.push_back(planFrame(kind, options.seed, size, model));
            progress.update(frames.size());
        }
    }
    console.out << "What a rank has to do in a frame, on average, counted over random spheres ("
                << options.scene << "):\n";
    printTable(planTable(frames), console.out);
    console.out << "Times by a model: " << model.objectNanoseconds << " ns a sphere, "
                << model.ghostNanoseconds << " ns a ghost, " << model.messageMicroseconds
                << " us a message sent or taken, " << model.stepMicroseconds
                << " us for each of log2(ranks) steps of a barrier and two sums, "
                << model.bytesPerNanosecond << " GB/s a rank.\n";
    for (const std::string& sentence : planSentences(frames)) {
        console.out << sentence << '\n';
    }
    return kExitOk;
}

constexpr std::uint64_t kMostAlone = std::uint64_t{1} << 28;  // what a Grid takes

constexpr const char* kRankVariables[] = {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"};

bool isStartedByMpirun() {
    return std::ranges::any_of(kRankVariables,
                               [](const char* name) { return std::getenv(name) != nullptr; });
}

/// Runs this program under mpirun in place of this process.
int runUnderMpirun(const SwarmOptions& options, const std::vector<std::string>& arguments,
                   Console& console) {
    // What Open MPI wants to be asked for: to run as root in a container, and more ranks than cores.
    for (const char* name : {"OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM",
                             "OMPI_MCA_rmaps_base_oversubscribe"}) {
        setEnvironment(name, "1");
    }
    // It waits this long [s] before it passes an interruption on to the ranks, and again before it kills them: they
    // need the time for their frame and their report.
    setEnvironment("OMPI_MCA_odls_base_sigkill_timeout", "3");
    std::vector<std::string> all{"-n", std::to_string(options.ranks),
                                 programBeside("hashphase-swarm").string()};
    all.insert(all.end(), arguments.begin(), arguments.end());
    try {
        return runInstead(HASHPHASE_MPIEXEC, std::move(all));
    } catch (const std::system_error& failure) {
        return refuse(console, std::string(HASHPHASE_MPIEXEC) +
                                   " cannot be run: " + failure.code().message() +
                                   ". It comes with Open MPI (Debian, Ubuntu: openmpi-bin).");
    }
}

/// MPI from the beginning to the end of a run; where that has failed, all processes end.
class MpiSession {
public:
    MpiSession() {
        MPI_Init(nullptr, nullptr);
        MPI_Comm_rank(MPI_COMM_WORLD, &rank);
        MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    }
    MpiSession(const MpiSession&) = delete;
    MpiSession& operator=(const MpiSession&) = delete;
    ~MpiSession() {
        if (hasFailed) {
            MPI_Abort(MPI_COMM_WORLD, kExitUsage);
        }
        MPI_Finalize();
    }

    int rank = 0;
    int ranks = 1;
    bool hasFailed = false;
};

SwarmResult runAllRanks(const SwarmScene& scene, const SwarmOptions& options, Console& console,
                        const MpiSession& mpi) {
    DistributedConfig config;
    config.rebalanceAbove = options.rebalanceAbove;
    config.patience = options.patience;
    SwarmFiles files(options.vtkFolder, static_cast<std::uint32_t>(mpi.rank), scene.side());
    meet(MPI_COMM_WORLD);  // the folder is there
    Progress progress(console.err, progressStyle(console, options.quiet || mpi.rank != 0), "swarm",
                      options.frames);
    SwarmResult result = runSwarm(MPI_COMM_WORLD, scene, options.frames, config,
                                  [&](std::uint32_t frame, const DistributedGrid<float>& grid) {
                                      if (frame % options.vtkEvery == 0) {
                                          files.write(frame, grid.here());
                                      }
                                      progress.update(frame + 1);
                                  });
    files.finish();
    return result;
}

// Nothing after an interruption.
SingleRun runToCompare(const SwarmScene& scene, const SwarmOptions& options, Console& console) {
    Progress progress(console.err, progressStyle(console, options.quiet), "one process",
                      options.frames);
    try {
        return tryAlone(scene, options.frames, [&](std::uint32_t frame) {
            progress.update(frame + 1);
            throwIfInterrupted();
        });
    } catch (const Interrupted&) {
        return {};
    }
}

int report(const SwarmResult& result, const SingleRun& alone, const Provenance& provenance,
           ResultFile& csv, std::ostream& out) {
    printSwarm(result, alone.result, out);
    printProvenance(provenance, out);
    const bool holds = printComparison(result, alone, out);
    if (!alone.result && (result.isInterrupted || isInterrupted())) {
        out << "The run was interrupted after " << withThousands(result.frames.size())
            << " frames.\n";
    }
    csv.write([&](std::ostream& file) { writeCsv(framesTable(result), file); });
    return holds ? kExitOk : kExitCheckFailed;
}

/// The other ranks on this machine are no other programs. All ranks call it together.
std::optional<ProcessorTimes> timesOfAllRanks() {
    std::optional<ProcessorTimes> times = processorTimes();
    double own = times ? times->own : 0;
    MPI_Comm here = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here);
    MPI_Allreduce(MPI_IN_PLACE, &own, 1, MPI_DOUBLE, MPI_SUM, here);
    MPI_Comm_free(&here);
    if (times) {
        times->own = own;
    }
    return times;
}

int runRank(const SwarmOptions& options, SwarmKind kind, Console& console, const MpiSession& mpi) {
    const bool isFirst = mpi.rank == 0;
    ResultFile csv(isFirst ? options.csvFile : std::string());
    Provenance provenance = gatherProvenance(console.commandLine);
    const OtherPrograms others(timesOfAllRanks);
    const SwarmScene scene(kind, options.objects, options.seed);
    if (isFirst) {
        console.out << withThousands(options.objects) << " spheres (" << options.scene << "), "
                    << options.frames << " frames on " << mpi.ranks
                    << (mpi.ranks == 1 ? " rank\n" : " ranks\n") << std::flush;
    }
    const SwarmResult result = runAllRanks(scene, options, console, mpi);
    SingleRun alone;
    if (isFirst && !options.unchecked && !result.isInterrupted) {
        alone = runToCompare(scene, options, console);
    }
    meet(MPI_COMM_WORLD);
    provenance.coresOfOthers = others.cores();
    return isFirst ? report(result, alone, provenance, csv, console.out) : kExitOk;
}

/// Whoever knows more than the others says it, and rank 0 what all know.
void tellFault(int rank, const std::string& sentence) {
    const bool isOwn = sentence.starts_with("Rank " + std::to_string(rank) + " of ");
    if (rank == 0 || isOwn) {
        std::cerr << "hashphase: " + sentence + "\n" << std::flush;
    }
}

int runSwarmCommand(const SwarmOptions& options, const std::vector<std::string>& arguments,
                    Console& console) {
    if (options.list) {
        printList(console.out);
        return kExitOk;
    }
    if (options.plan) {
        return printPlan(options, console);
    }
    const SwarmKind kind = chosenKind(options.scene);
    if (options.objects > kMostAlone && !options.unchecked) {
        return refuse(console, "One process takes at most " + withThousands(kMostAlone) +
                                   " spheres: add --unchecked, so that " +
                                   withThousands(options.objects) + " are not compared with it.");
    }
    if (options.ranks != 0 && !isStartedByMpirun()) {
        return runUnderMpirun(options, arguments, console);
    }
    MpiSession mpi;
    if (options.ranks != 0 && options.ranks != static_cast<std::uint32_t>(mpi.ranks)) {
        return refuse(console, "--ranks says " + std::to_string(options.ranks) +
                                   ", but mpirun has started " + std::to_string(mpi.ranks) + ".");
    }
    try {
        return runRank(options, kind, console, mpi);
    } catch (const RankError& error) {
        tellFault(mpi.rank, error.what());
        // Whoever knows why is to have said it before all are ended.
        std::this_thread::sleep_for(std::chrono::seconds(1));
    } catch (const std::exception& error) {
        std::cerr << "hashphase: " + std::string(error.what()) + " (on rank " +
                         std::to_string(mpi.rank) + ")\n"
                  << std::flush;
    }
    mpi.hasFailed = true;
    return kExitUsage;
}

}  // namespace

Subcommand swarmCommand(const std::vector<std::string>& arguments) {
    return makeSubcommand<SwarmOptions>("swarm", declareSwarm,
                                        [arguments](const auto& options, Console& console) {
                                            return runSwarmCommand(options, arguments, console);
                                        });
}

int rankByEnvironment() noexcept {
    for (const char* name : kRankVariables) {
        if (const char* value = std::getenv(name)) {
            return std::atoi(value);
        }
    }
    return 0;
}

}  // namespace hashphase::demos
