// Preloaded into a program (LD_PRELOAD): lets one call of the file system fail, or ends the process there.
//
// FAULT_CALL   which call: open write fsync rename close ftruncate unlink mkdir mmap pwrite, or `any`
// FAULT_NTH    the n-th of these, counted over all processes of the trial, from 1
// FAULT_KIND   EIO, ENOSPC, EDQUOT, EINTR: errno; `short`: half of the bytes are written; `kill`: SIGKILL
//              before the call, `killed`: after it
// FAULT_TIMES  how many calls from there on fail; 1 unless given
// FAULT_ROOT   only files below this folder count, and with FAULT_PIPES=1 pipes and sockets, too
// FAULT_COUNT  a file of two 64-bit integers: calls that counted, and faults that struck

#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

struct Counters {
  _Atomic long calls;
  _Atomic long faults;
};

static struct Counters* counters;
static const char* call_name;
static const char* kind;
static const char* root;
static long nth, times;
static bool pipes;

#define REAL(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))

__attribute__((constructor)) static void set_up(void) {
  const char* file = getenv("FAULT_COUNT");
  const char* text = getenv("FAULT_TIMES");
  call_name = getenv("FAULT_CALL");
  kind = getenv("FAULT_KIND");
  root = getenv("FAULT_ROOT");
  pipes = getenv("FAULT_PIPES") != NULL;
  times = text ? atol(text) : 1;
  text = getenv("FAULT_NTH");
  nth = text ? atol(text) : 0;
  if (!file || !call_name || !kind || !root)
    return;
  const int descriptor = (int)syscall(SYS_openat, AT_FDCWD, file, O_RDWR | O_CLOEXEC, 0);
  if (descriptor < 0)
    return;
  void* memory = (void*)syscall(SYS_mmap, NULL, sizeof *counters, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0L);
  counters = memory == MAP_FAILED ? NULL : memory;
  syscall(SYS_close, descriptor);
}

static bool below_root(const char* path) {
  return path && strncmp(path, root, strlen(root)) == 0;
}

static bool descriptor_counts(int descriptor) {
  char link[64], path[PATH_MAX];
  snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
  const ssize_t length = readlink(link, path, sizeof path - 1);
  if (length <= 0)
    return false;
  path[length] = '\0';
  return below_root(path) || (pipes && (strncmp(path, "pipe:", 5) == 0 || strncmp(path, "socket:", 7) == 0));
}

// Whether this call is one that fails.
static bool strikes(const char* name, bool counts) {
  if (!counters || !counts || (strcmp(call_name, name) != 0 && strcmp(call_name, "any") != 0))
    return false;
  const long call = atomic_fetch_add(&counters->calls, 1) + 1;
  if (call < nth || call >= nth + times)
    return false;
  atomic_fetch_add(&counters->faults, 1);
  if (strcmp(kind, "kill") == 0)
    syscall(SYS_kill, getpid(), SIGKILL);
  return true;
}

static bool is(const char* name) { return strcmp(kind, name) == 0; }

static int failure(void) {
  errno = is("ENOSPC") ? ENOSPC : is("EDQUOT") ? EDQUOT : is("EINTR") ? EINTR : EIO;
  return -1;
}

// A call that fails with errno, or is followed by the end of the process.
#define CALL(name, counts, ...)                      \
  do {                                               \
    const bool struck = counters && strikes(#name, counts); \
    if (struck && !is("killed"))                     \
      return failure();                              \
    const __typeof__(REAL(name)(__VA_ARGS__)) result = REAL(name)(__VA_ARGS__); \
    if (struck)                                      \
      syscall(SYS_kill, getpid(), SIGKILL);          \
    return result;                                   \
  } while (0)

static mode_t mode_of(int flags, va_list list) { return (flags & (O_CREAT | O_TMPFILE)) ? va_arg(list, mode_t) : 0; }

int open(const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const mode_t mode = mode_of(flags, list);
  va_end(list);
  CALL(open, below_root(path), path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list list;
  va_start(list, flags);
  const mode_t mode = mode_of(flags, list);
  va_end(list);
  if (counters && strikes("open", below_root(path)) && !is("killed"))
    return failure();
  return REAL(open64)(path, flags, mode);
}

FILE* fopen64(const char* path, const char* mode) {  // what streams of C++ open
  if (counters && strikes("open", below_root(path)) && !is("killed")) {
    failure();
    return NULL;
  }
  return REAL(fopen64)(path, mode);
}

ssize_t write(int descriptor, const void* bytes, size_t count) {
  const bool struck = counters && strikes("write", descriptor_counts(descriptor));
  if (struck && !is("short") && !is("killed"))
    return failure();
  const ssize_t written = REAL(write)(descriptor, bytes, struck && count > 1 ? count / 2 : count);
  if (struck && is("killed"))
    syscall(SYS_kill, getpid(), SIGKILL);
  return written;
}

ssize_t pwrite64(int descriptor, const void* bytes, size_t count, off64_t offset) {
  const bool struck = counters && strikes("pwrite", descriptor_counts(descriptor));
  if (struck && !is("short") && !is("killed"))
    return failure();
  return REAL(pwrite64)(descriptor, bytes, struck && count > 1 ? count / 2 : count, offset);
}

int fsync(int descriptor) { CALL(fsync, descriptor_counts(descriptor), descriptor); }
int rename(const char* from, const char* to) { CALL(rename, below_root(to), from, to); }
int ftruncate64(int descriptor, off64_t length) { CALL(ftruncate, descriptor_counts(descriptor), descriptor, length); }
int ftruncate(int descriptor, off_t length) { CALL(ftruncate, descriptor_counts(descriptor), descriptor, length); }
int unlink(const char* path) { CALL(unlink, below_root(path), path); }
int mkdir(const char* path, mode_t mode) { CALL(mkdir, below_root(path), path, mode); }

int remove(const char* path) {  // by which std::filesystem removes
  if (counters && strikes("unlink", below_root(path)) && !is("killed"))
    return failure();
  return REAL(remove)(path);
}

// As Linux does it: a close that fails has closed.
int close(int descriptor) {
  const bool struck = counters && strikes("close", descriptor_counts(descriptor));
  const int result = REAL(close)(descriptor);
  if (struck && is("killed"))
    syscall(SYS_kill, getpid(), SIGKILL);
  return struck ? failure() : result;
}

void* mmap(void* address, size_t length, int protection, int flags, int descriptor, off_t offset) {
  if (counters && descriptor >= 0 && strikes("mmap", descriptor_counts(descriptor)) && !is("killed")) {
    failure();
    return MAP_FAILED;
  }
  return (void*)syscall(SYS_mmap, address, length, protection, flags, descriptor, offset);
}
