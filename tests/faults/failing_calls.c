/* A library that is loaded before a program (LD_PRELOAD) and lets some of its calls fail:
 *   AYUMI_FAULT=KIND:N       the N-th call of this kind fails, once
 *   AYUMI_FAULT=KIND:N+      this call and all after it fail
 *   AYUMI_FAULT=bytes:N      the disk is full after N bytes
 * Kinds: alloc, open, write, rename, fsync, fork. With AYUMI_FAULT_COUNT=FILE and without
 * AYUMI_FAULT, the numbers of calls are written to that file at the end of the program. Only what
 * happens under main() of the program itself counts: its children run undisturbed. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

enum kind { ALLOC, OPEN, WRITE, RENAME, FSYNC, FORK, KINDS };
static const char *const names[KINDS] = {"alloc", "open", "write", "rename", "fsync", "fork"};

static atomic_long counts[KINDS];
static atomic_long written;
static long fails_at = 0, fails_until = 0, room = -1;
static int failing = -1;
static int active = 0;

extern void *__libc_malloc(size_t);
extern void *__libc_calloc(size_t, size_t);
extern void *__libc_realloc(void *, size_t);
extern void *__libc_memalign(size_t, size_t);

static int fails(enum kind kind) {
  if (!active) return 0;
  const long n = atomic_fetch_add(&counts[kind], 1) + 1;
  return kind == (enum kind)failing && n >= fails_at && n <= fails_until;
}

/* How many of `size` bytes the disk still takes; -1: none. */
static ssize_t room_for(size_t size) {
  if (!active || room < 0) return (ssize_t)size;
  const long before = atomic_fetch_add(&written, (long)size);
  if (before >= room) return -1;
  return before + (long)size <= room ? (ssize_t)size : room - before;
}

__attribute__((constructor)) static void begin(void) {
  const char *const fault = getenv("AYUMI_FAULT");
  if (fault) {
    const char *const colon = strchr(fault, ':');
    const size_t length = colon ? (size_t)(colon - fault) : 0;
    if (length == 5 && strncmp(fault, "bytes", 5) == 0) room = atol(colon + 1);
    for (int kind = 0; kind < KINDS; ++kind)
      if (colon && strlen(names[kind]) == length && strncmp(fault, names[kind], length) == 0)
        failing = kind;
    fails_at = colon ? atol(colon + 1) : 0;
    fails_until = strchr(fault, '+') ? 0x7fffffffffffL : fails_at;
  }
  unsetenv("LD_PRELOAD");
  unsetenv("AYUMI_FAULT");
  active = 1;
}

__attribute__((destructor)) static void end(void) {
  active = 0;
  const char *const file = getenv("AYUMI_FAULT_COUNT");
  FILE *const out = file ? fopen(file, "w") : NULL;
  if (!out) return;
  for (int kind = 0; kind < KINDS; ++kind)
    fprintf(out, "%s %ld\n", names[kind], atomic_load(&counts[kind]));
  fclose(out);
}

#define NEXT(name)                                        \
  static __typeof__(&name) next;                          \
  if (!next) *(void **)&next = dlsym(RTLD_NEXT, #name)

static void *refused_memory(void) {
  errno = ENOMEM;
  return NULL;
}

void *malloc(size_t size) { return fails(ALLOC) ? refused_memory() : __libc_malloc(size); }
void *calloc(size_t n, size_t size) {
  return fails(ALLOC) ? refused_memory() : __libc_calloc(n, size);
}
void *realloc(void *old, size_t size) {
  return fails(ALLOC) ? refused_memory() : __libc_realloc(old, size);
}
void *aligned_alloc(size_t alignment, size_t size) {
  return fails(ALLOC) ? refused_memory() : __libc_memalign(alignment, size);
}
int posix_memalign(void **place, size_t alignment, size_t size) {
  if (fails(ALLOC)) return ENOMEM;
  *place = __libc_memalign(alignment, size);
  return *place ? 0 : ENOMEM;
}

static int refused(int reason) {
  errno = reason;
  return -1;
}

#define OPENING(name)                                          \
  int name(const char *path, int flags, ...) {                 \
    NEXT(name);                                                \
    va_list more;                                              \
    va_start(more, flags);                                     \
    const mode_t mode = va_arg(more, mode_t);                  \
    va_end(more);                                              \
    return fails(OPEN) ? refused(EMFILE) : next(path, flags, mode); \
  }
OPENING(open)
OPENING(open64)

#define OPENING_STREAM(name)                            \
  FILE *name(const char *path, const char *mode) {      \
    NEXT(name);                                         \
    if (!fails(OPEN)) return next(path, mode);          \
    errno = EMFILE;                                     \
    return NULL;                                        \
  }
OPENING_STREAM(fopen)
OPENING_STREAM(fopen64)

/* A full disk takes what still fits, and refuses the next call. Streams of the program itself, which
 * are no files, are not disturbed. */
static int is_file(int descriptor) {
  struct stat about;
  return fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode);
}

ssize_t write(int descriptor, const void *bytes, size_t size) {
  NEXT(write);
  if (!is_file(descriptor)) return next(descriptor, bytes, size);
  if (fails(WRITE)) return refused(EIO);
  const ssize_t fits = room_for(size);
  return fits < 0 ? refused(ENOSPC) : next(descriptor, bytes, (size_t)fits);
}
ssize_t writev(int descriptor, const struct iovec *parts, int count) {
  NEXT(writev);
  if (!is_file(descriptor)) return next(descriptor, parts, count);
  size_t size = 0;
  for (int i = 0; i < count; ++i) size += parts[i].iov_len;
  if (fails(WRITE)) return refused(EIO);
  const ssize_t fits = room_for(size);
  if (fits == (ssize_t)size) return next(descriptor, parts, count);
  if (fits < 0) return refused(ENOSPC);
  const size_t first = parts[0].iov_len < (size_t)fits ? parts[0].iov_len : (size_t)fits;
  return write(descriptor, parts[0].iov_base, first);
}
size_t fwrite(const void *bytes, size_t size, size_t n, FILE *file) {
  NEXT(fwrite);
  if (!is_file(fileno(file))) return next(bytes, size, n, file);
  if (fails(WRITE)) return (size_t)refused(EIO) & 0;
  const ssize_t fits = room_for(size * n);
  if (fits == (ssize_t)(size * n)) return next(bytes, size, n, file);
  errno = ENOSPC;
  return 0;
}

int rename(const char *from, const char *to) {
  NEXT(rename);
  return fails(RENAME) ? refused(EIO) : next(from, to);
}
int fsync(int descriptor) {
  NEXT(fsync);
  return fails(FSYNC) ? refused(EIO) : next(descriptor);
}
int fdatasync(int descriptor) {
  NEXT(fdatasync);
  return fails(FSYNC) ? refused(EIO) : next(descriptor);
}
/* vfork() cannot be wrapped: the child would return through the frame of the wrapper. It calls
 * clone(), which the program does not see; so a fork fails by a limit on processes instead. */
pid_t fork(void) {
  NEXT(fork);
  return fails(FORK) ? refused(EAGAIN) : next();
}
int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*work)(void *),
                   void *argument) {
  NEXT(pthread_create);
  return fails(FORK) ? EAGAIN : next(thread, attributes, work, argument);
}
