#include <malloc.h>
#include <stdlib.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>

#include "cli/command.h"
#include "core/error.h"
#include "core/parallel.h"

namespace {

constexpr int kWrongUsage = 2;

int Main(int argc, char** argv) {
  using namespace simwright;
  CLI::App app{"Photos and meshes become assets that hold in simulation."};
  app.name("simwright");
  app.footer(
      "Example:\n  simwright lift examples/apple.jpg --category apple -o apple\n"
      "Each subcommand has its own --help with an example.");
  app.require_subcommand(1);
  app.set_config("--config", "",
                 "Read flags from a TOML file, a section a subcommand; "
                 "flags given here win");
  cli::CommonOptions common;
  cli::Run run;
  cli::AddLift(&app, &common, &run);
  cli::AddImport(&app, &common, &run);
  cli::AddPhysics(&app, &common, &run);
  cli::AddCheck(&app, &common, &run);
  cli::AddLibrary(&app, &common, &run);
  cli::AddPrior(&app, &common, &run);
  cli::AddTasks(&app, &common, &run);
  cli::AddReward(&app, &common, &run);
  cli::AddTrain(&app, &common, &run);
  cli::AddRollout(&app, &common, &run);
  cli::AddExport(&app, &common, &run);
  cli::AddReplay(&app, &common, &run);
  cli::AddScene(&app, &common, &run);
  cli::AddRun(&app, &common, &run);
  cli::AddDoctor(&app, &common, &run);
  cli::AddVersion(&app, &run);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);
    return code == 0 ? 0 : kWrongUsage;
  }
  core::InstallCancelHandler();
  core::SetThreadCount(common.threads);
  return run();
}

// libtorch's threads wait for each other by spinning, unless told otherwise before its OpenMP
// starts: beside other work a network then runs several times slower. And OpenBLAS 0.3.21 takes
// processors that are newer than itself for ones of 2004, four times slower than their AVX-512.
// Both are told by starting once more, which takes a second that only those who run networks should
// wait.
void StartWithThreadsAndKernels(int argc, char** argv) {
  if (std::getenv("OMP_WAIT_POLICY") != nullptr) return;
  const std::string_view command = argc > 1 ? argv[1] : "";
  if (command != "lift" && command != "prior" && command != "train" && command != "run" &&
      command != "scene") {
    return;
  }
  setenv("OMP_WAIT_POLICY", "passive", 1);
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq")) {
    setenv("OPENBLAS_CORETYPE", "SkylakeX", 0);
  }
#endif
  execv("/proc/self/exe", argv);  // where that fails the program goes on as it is
}

// A network's tensors come and go by the megabyte: given back to the system every time, a sixth of
// a training's time went into clearing fresh pages.
void KeepFreedMemory() {
  mallopt(M_MMAP_THRESHOLD, 1 << 28);
  mallopt(M_TRIM_THRESHOLD, 1 << 29);
}

}  // namespace

int main(int argc, char** argv) {
  StartWithThreadsAndKernels(argc, argv);
  KeepFreedMemory();
  try {
    return Main(argc, argv);
  } catch (const simwright::core::Cancelled&) {
    std::fprintf(stderr, "error: stopped; nothing was written\n");
    return simwright::cli::kInterrupted;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "error: out of memory (close other programs, or use a smaller input)\n");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
  }
  return 1;
}
