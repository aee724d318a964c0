#include "confinement.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#ifdef AYUMI_HAS_SECCOMP
#include <seccomp.h>
#endif

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define AYUMI_SANITIZED 1
#endif

namespace ayumi::mesh_reader {

namespace {

// The first number of /proc/self/statm is the size of the address space in pages.
int memory_file = -1;
// The address space before the first mesh [bytes]. Limits are added to this number. It does not
// contain the memory that the heap keeps from earlier meshes, because this memory is reused.
std::uint64_t own_space = 0;

std::uint64_t address_space() {
  // The address space if there is no /proc. Chosen: the libraries of a reader take 0.1 GiB.
  constexpr std::uint64_t kUnknown = std::uint64_t{256} << 20;
  char words[64] = {};
  if (pread(memory_file, words, sizeof words - 1, 0) <= 0) return kUnknown;
  return std::strtoull(words, nullptr, 10) * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

// Sets the soft limit, but never above the one with which this process was started.
void set_soft_limit(int resource, std::uint64_t value) {
  rlimit now{};
  if (getrlimit(static_cast<__rlimit_resource>(resource), &now) != 0) _exit(1);
  now.rlim_cur = std::min<rlim_t>(value, now.rlim_max);
  if (setrlimit(static_cast<__rlimit_resource>(resource), &now) != 0) _exit(1);
}

#if defined(AYUMI_HAS_SECCOMP) && !defined(AYUMI_SANITIZED)
// Every other system call fails with EPERM. The list has the calls that assimp needs. Calls that it
// does not need, such as those that open files without the given interface, just fail. If the
// kernel has no filters, the limits remain.
void filter_system_calls() {
  scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
  if (!filter) return;
  bool good = true;
  const auto allow = [&](int call) {
    good = good && seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0) == 0;
  };
  for (const int call :
       {SCMP_SYS(recvfrom), SCMP_SYS(brk), SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(madvise),
        SCMP_SYS(futex), SCMP_SYS(exit), SCMP_SYS(exit_group), SCMP_SYS(rt_sigreturn),
        SCMP_SYS(getpid), SCMP_SYS(gettid), SCMP_SYS(rt_sigprocmask), SCMP_SYS(getrusage),
        SCMP_SYS(clock_gettime), SCMP_SYS(getrandom)})
    allow(call);
  const auto allow_if = [&](int call, scmp_arg_cmp what) {
    good = good && seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 1, what) == 0;
  };
  // sendto() is allowed only without an address, so that it can only send on the existing
  // connection.
  allow_if(SCMP_SYS(sendto), SCMP_A4(SCMP_CMP_EQ, 0));
  allow_if(SCMP_SYS(pread64), SCMP_A0(SCMP_CMP_EQ, static_cast<scmp_datum_t>(memory_file)));
  allow_if(SCMP_SYS(mmap), SCMP_A2(SCMP_CMP_MASKED_EQ, PROT_EXEC, 0));
  allow_if(SCMP_SYS(mprotect), SCMP_A2(SCMP_CMP_MASKED_EQ, PROT_EXEC, 0));
  // Only calls that concern the process's own limits are allowed, and abort(), which sends a signal
  // to the process itself.
  allow_if(SCMP_SYS(prlimit64), SCMP_A0(SCMP_CMP_EQ, 0));
  allow_if(SCMP_SYS(tgkill), SCMP_A0(SCMP_CMP_EQ, static_cast<scmp_datum_t>(getpid())));
  if (good) seccomp_load(filter);
  seccomp_release(filter);
}
#endif

}  // namespace

void confine() {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  const rlimit none{0, 0};
  if (setrlimit(RLIMIT_FSIZE, &none) != 0 || setrlimit(RLIMIT_CORE, &none) != 0) _exit(1);
  memory_file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  own_space = address_space();
  // Size of the free memory that the heap keeps, and size from which on a block is not part of the
  // heap [bytes]. The heap keeps the memory of a mesh for the next one, because clearing new pages
  // takes most of the time of a small mesh: assimp takes a buffer of 16 MiB for each OBJ. Chosen:
  // both are larger than this buffer; the second is the largest value that mallopt() takes.
  constexpr int kKept = 64 << 20, kOnItsOwn = 32 << 20;
  mallopt(M_TRIM_THRESHOLD, kKept);
  mallopt(M_MMAP_THRESHOLD, kOnItsOwn);
#if defined(AYUMI_HAS_SECCOMP) && !defined(AYUMI_SANITIZED)
  filter_system_calls();
#endif
}

void limit(std::uint64_t bytes, std::uint64_t seconds) {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  set_soft_limit(
      RLIMIT_CPU,
      seconds + 1 + static_cast<std::uint64_t>(used.ru_utime.tv_sec + used.ru_stime.tv_sec));
#ifndef AYUMI_SANITIZED
  set_soft_limit(RLIMIT_AS, own_space + bytes);
#else
  static_cast<void>(bytes);
#endif
}

void allow_more_memory(std::uint64_t bytes) {
#ifndef AYUMI_SANITIZED
  rlimit now{};
  if (getrlimit(RLIMIT_AS, &now) == 0) set_soft_limit(RLIMIT_AS, now.rlim_cur + bytes);
#else
  static_cast<void>(bytes);
#endif
}

}  // namespace ayumi::mesh_reader
