// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tests/io/scratch_folder.h"
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

namespace plumbline {

// A Slurm cluster of two nodes with one processor each, all on this machine, with a munge of its
// own: daemons in a folder, started and stopped with this object. SLURM_CONF names its
// configuration meanwhile.
class SlurmCluster {
 public:
  // Returns true if Slurm is installed, and PLUMBLINE_SLURM is set, as by ./test --full.
  static bool IsWanted() {
    // NOLINTNEXTLINE(concurrency-mt-unsafe): tests have one thread
    if (std::getenv("PLUMBLINE_SLURM") == nullptr) return false;
    return std::filesystem::exists("/usr/sbin/slurmctld") &&
           std::filesystem::exists("/usr/sbin/slurmd") &&
           std::filesystem::exists("/usr/sbin/munged");
  }

  SlurmCluster() {
    for (const char* name : {"state", "n1", "n2"}) {
      std::filesystem::create_directories(folder_ / name);
    }
    std::filesystem::permissions(folder_.path(), std::filesystem::perms(0755));
    folder_.Write("munge.key", std::string(1024, 'k'));
    std::filesystem::permissions(folder_ / "munge.key", std::filesystem::perms(0400));
    folder_.Write("slurm.conf", Configuration());
    ::setenv("SLURM_CONF", (folder_ / "slurm.conf").c_str(), 1);  // NOLINT(concurrency-mt-unsafe)
    daemons_.push_back(Start({"/usr/sbin/munged",
                              "--force",
                              "--foreground",
                              "--key-file=" + (folder_ / "munge.key").string(),
                              "--socket=" + (folder_ / "munge.socket").string(),
                              "--pid-file=" + (folder_ / "munge.pid").string(),
                              "--log-file=" + (folder_ / "munge.log").string(),
                              "--seed-file=" + (folder_ / "munge.seed").string()}));
    Until([&] { return std::filesystem::exists(folder_ / "munge.socket"); });
    const std::string conf = (folder_ / "slurm.conf").string();
    daemons_.push_back(Start({"/usr/sbin/slurmctld", "-D", "-f", conf}));
    for (const char* node : {"n1", "n2"}) StartNode(node);
    works_ = Until([&] { return Say("sinfo -h -o %T") == "idle\n"; });
  }
  SlurmCluster(const SlurmCluster&) = delete;
  SlurmCluster& operator=(const SlurmCluster&) = delete;

  ~SlurmCluster() {
    Say("scancel --state=PENDING,RUNNING -u $(id -un)");
    for (auto it = daemons_.rbegin(); it != daemons_.rend(); ++it) Stop(*it, SIGTERM);
    ::unsetenv("SLURM_CONF");  // NOLINT(concurrency-mt-unsafe)
  }

  // Returns true if both nodes started.
  bool works() const { return works_; }
  std::string Log() const { return Contents(folder_ / "slurmctld.log"); }

  // Returns the output of a shell command.
  std::string Say(const std::string& command) const {
    const std::string out = (folder_ / "said").string();
    // NOLINTNEXTLINE(concurrency-mt-unsafe)
    if (std::system((command + " > '" + out + "' 2>/dev/null").c_str()) != 0) return "";
    return Contents(out);
  }

  // Kills a node like a machine failure: its daemon, and all processes of its jobs. Jobs that have
  // started by then (their script runs) do not go on.
  void KillNode(int node) {
    pid_t& daemon = daemons_.at(static_cast<std::size_t>(1 + node));
    ::kill(daemon, SIGSTOP);  // it starts nothing more
    std::vector<pid_t> alive = Below(daemon);
    ::kill(daemon, SIGKILL);
    ::waitpid(daemon, nullptr, 0);
    daemon = -1;
    Until([&] {
      const std::vector<pid_t> of_jobs = ProcessesOf(fmt::format("n{}", node));
      alive.insert(alive.end(), of_jobs.begin(), of_jobs.end());
      for (const pid_t process : alive) ::kill(process, SIGKILL);
      alive.clear();
      return of_jobs.empty();  // a process may have started another one before it was killed
    });
  }

  // Returns the descendants of a process.
  static std::vector<pid_t> Below(pid_t parent) {
    std::vector<pid_t> found;
    for (const auto& [process, its_parent] : Processes()) {
      if (its_parent != parent) continue;
      found.push_back(process);
      const std::vector<pid_t> further = Below(process);
      found.insert(found.end(), further.begin(), further.end());
    }
    return found;
  }

  template <class Condition>
  static bool Until(const Condition& condition, int seconds = 60) {
    for (int i = 0; i < 20 * seconds; ++i) {
      if (condition()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return false;
  }

 private:
  static std::vector<std::pair<pid_t, pid_t>> Processes() {
    std::vector<std::pair<pid_t, pid_t>> processes;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      const std::string name = entry.path().filename().string();
      if (name.find_first_not_of("0123456789") != std::string::npos) continue;
      const std::string stat = Read(entry.path() / "stat");
      const auto bracket = stat.rfind(')');
      if (bracket == std::string::npos) continue;
      std::istringstream fields(stat.substr(bracket + 1));
      std::string state;
      pid_t parent = 0;
      fields >> state >> parent;
      processes.emplace_back(std::stoi(name), parent);
    }
    return processes;
  }

  // Returns the processes of the jobs on a node of this cluster, which have its configuration and
  // its name in their environment, and the slurmstepd processes above them, which do not.
  std::vector<pid_t> ProcessesOf(const std::string& node) const {
    const std::string conf = "SLURM_CONF=" + (folder_ / "slurm.conf").string();
    const std::string name = "SLURMD_NODENAME=" + node;
    const auto is_its = [&](pid_t process) {
      const std::string environment = '\0' + Read(Proc(process) / "environ");
      return environment.find('\0' + conf + '\0') != std::string::npos &&
             environment.find('\0' + name + '\0') != std::string::npos;
    };
    std::vector<pid_t> found;
    for (const auto& [process, parent] : Processes()) {
      if (!is_its(process)) continue;
      found.push_back(process);
      if (Read(Proc(parent) / "comm").starts_with("slurmstepd")) found.push_back(parent);
    }
    return found;
  }

  static std::filesystem::path Proc(pid_t process) {
    return std::filesystem::path("/proc") / std::to_string(process);
  }

  static std::string Read(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
  }

  void StartNode(const std::string& name) {
    daemons_.push_back(
        Start({"/usr/sbin/slurmd", "-D", "-N", name, "-f", (folder_ / "slurm.conf").string()}));
  }

  static pid_t Start(const std::vector<std::string>& command) {
    std::vector<std::string> words = command;
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    const pid_t child = ::fork();
    if (child == 0) {
      const int null = ::open("/dev/null", O_RDWR);
      for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::dup2(null, stream);
      ::execv(argv[0], argv.data());
      ::_exit(127);
    }
    return child;
  }

  static void Stop(pid_t process, int signal) {
    if (process <= 0) return;
    ::kill(process, signal);
    for (int i = 0; i < 100; ++i) {
      if (::waitpid(process, nullptr, WNOHANG) == process) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    ::kill(process, SIGKILL);
    ::waitpid(process, nullptr, 0);
  }

  std::string Configuration() const {
    std::array<char, 256> host{};
    ::gethostname(host.data(), host.size() - 1);
    const std::string name = std::string(host.data()).substr(0, std::string(host.data()).find('.'));
    const std::string at = folder_.path().string();
    const int port = 20000 + 4 * (::getpid() % 5000);
    return fmt::format(
        "ClusterName=plumbline\nSlurmctldHost={0}(127.0.0.1)\nSlurmctldPort={1}\n"
        "SlurmUser={7}\nSlurmdUser={7}\nAuthType=auth/munge\nAuthInfo=socket={4}/munge.socket\n"
        "CredType=cred/munge\nMpiDefault=none\nProctrackType=proctrack/linuxproc\n"
        "TaskPlugin=task/none\nSwitchType=switch/none\nSelectType=select/cons_tres\n"
        "SelectTypeParameters=CR_Core_Memory\nAccountingStorageType=accounting_storage/none\n"
        "JobAcctGatherType=jobacct_gather/linux\nJobAcctGatherFrequency=task=1\n"
        "JobAcctGatherParams=OverMemoryKill,UsePss\nJobCompType=jobcomp/none\nReturnToService=2\n"
        "SlurmdTimeout=5\nSlurmctldTimeout=5\nInactiveLimit=0\nKillWait=2\nMinJobAge=600\n"
        "MailProg=/bin/true\nMaxArraySize=1001\n"
        "SchedulerParameters=sched_interval=1,bf_interval=1\nStateSaveLocation={4}/state\n"
        "SlurmctldPidFile={4}/slurmctld.pid\nSlurmctldLogFile={4}/slurmctld.log\n"
        "SlurmdSpoolDir={4}/%n\nSlurmdPidFile={4}/%n.pid\nSlurmdLogFile={4}/%n.log\n"
        "NodeName=n1 NodeHostname={0} NodeAddr=127.0.0.1 Port={2} CPUs=1 RealMemory=2000\n"
        "NodeName=n2 NodeHostname={0} NodeAddr=127.0.0.1 Port={3} CPUs=1 RealMemory=2000\n"
        "PartitionName=main Nodes=n1,n2 Default=YES MaxTime=INFINITE State=UP{5}{6}\n",
        name,
        port,
        port + 1,
        port + 2,
        at,
        "",
        "",
        UserName());
  }

  static std::string UserName() {
    const char* name = ::getlogin();  // NOLINT(concurrency-mt-unsafe)
    return ::getuid() == 0 ? "root" : name != nullptr ? name : std::to_string(::getuid());
  }

  ScratchFolder folder_;
  std::vector<pid_t> daemons_;  // munged, slurmctld, n1, n2; -1: gone
  bool works_ = false;
};

}  // namespace plumbline
