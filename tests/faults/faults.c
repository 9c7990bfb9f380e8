/* A library to be preloaded: it makes one call of a program fail as a full disk or a broken one does.
 *
 *   FAULTS_PATH   only calls on files below this folder count, and threads
 *   FAULTS_CALLS  which calls count, by name: "write,fsync,rename"; all of them if left out
 *   FAULTS_AT     the number of the call that fails, from 1; none if left out
 *   FAULTS_ERROR  how: the name of an errno (ENOSPC, EIO, …); SHORT, a write or read of one byte; KILL, the
 *                 process ends there as by kill -9
 *   FAULTS_LAST   the number of the last call that fails; FAULTS_AT if left out, 0 for all that follow
 *   FAULTS_LOG    a file that gets a line for each call that counts: its number, name and path
 *
 * What the C library calls within itself cannot be seen from here: fopen is intercepted for its own sake, and
 * what goes through stdio (standard output) is not; /dev/full is there for that.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

static atomic_long calls;

static long number_in(const char* name, long otherwise) {
  const char* text = getenv(name);
  return text ? strtol(text, NULL, 10) : otherwise;
}

/* Whether `name` is one of the words of the list. */
static int is_listed(const char* name, const char* list) {
  const size_t length = strlen(name);
  for (const char* at = list; at; at = strchr(at, ',') ? strchr(at, ',') + 1 : NULL)
    if (strncmp(at, name, length) == 0 && (at[length] == ',' || at[length] == 0)) return 1;
  return 0;
}

static int error_named(const char* name) {
  const struct {
    const char* name;
    int number;
  } errors[] = {{"ENOSPC", ENOSPC}, {"EIO", EIO},     {"EINTR", EINTR}, {"EACCES", EACCES},
                {"EROFS", EROFS},   {"EDQUOT", EDQUOT}, {"ENOMEM", ENOMEM}, {"EMFILE", EMFILE},
                {"EAGAIN", EAGAIN}};
  for (size_t i = 0; i < sizeof errors / sizeof *errors; ++i)
    if (strcmp(name, errors[i].name) == 0) return errors[i].number;
  return EIO;
}

static void log_call(long number, const char* name, const char* path) {
  const char* file = getenv("FAULTS_LOG");
  if (!file) return;
  char line[PATH_MAX + 64];
  const int length = snprintf(line, sizeof line, "%ld %s %s\n", number, name, path);
  const int log = (int)syscall(SYS_openat, AT_FDCWD, file, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (log < 0) return;
  if (syscall(SYS_write, log, line, (size_t)length) < 0) abort();
  syscall(SYS_close, log);
}

enum { go_on = 0, make_short = -1 };

/* Counts the call. go_on, make_short, or the errno with which it has to fail. */
static int fault_at(const char* name, const char* path) {
  const int kept = errno;
  const char *below = getenv("FAULTS_PATH"), *list = getenv("FAULTS_CALLS");
  if (!below || strncmp(path, below, strlen(below)) != 0 || (list && !is_listed(name, list))) return go_on;
  const long number = ++calls, at = number_in("FAULTS_AT", 0), last = number_in("FAULTS_LAST", at);
  log_call(number, name, path);
  errno = kept;
  if (at == 0 || number < at || (last != 0 && number > last)) return go_on;
  const char* error = getenv("FAULTS_ERROR");
  if (!error) return EIO;
  if (strcmp(error, "KILL") == 0) raise(SIGKILL);
  return strcmp(error, "SHORT") == 0 ? make_short : error_named(error);
}

static int fault_at_file(const char* name, int file) {
  char link[64], path[PATH_MAX];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  const int kept = errno;
  const long length = syscall(SYS_readlink, link, path, sizeof path - 1);
  errno = kept;
  if (length < 0) return go_on;
  path[length] = 0;
  return fault_at(name, path);
}

/* A relative path stands for one below the working directory. */
static int fault_at_path(const char* name, const char* path) {
  char whole[2 * PATH_MAX];
  if (path[0] == '/') return fault_at(name, path);
  char folder[PATH_MAX];
  if (!getcwd(folder, sizeof folder)) return go_on;
  snprintf(whole, sizeof whole, "%s/%s", folder, path);
  return fault_at(name, whole);
}

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))
#define FAIL_OR(fault, failed, ...)                                                                                    \
  do {                                                                                                                 \
    const int found = (fault);                                                                                         \
    if (found > 0) return errno = found, (failed);                                                                     \
    return __VA_ARGS__;                                                                                                \
  } while (0)

static mode_t mode_of(int flags, va_list rest) { return flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, mode_t) : 0; }

#define OPEN(name)                                                                                                     \
  int name(const char* path, int flags, ...) {                                                                         \
    va_list rest;                                                                                                      \
    va_start(rest, flags);                                                                                             \
    const mode_t mode = mode_of(flags, rest);                                                                          \
    va_end(rest);                                                                                                      \
    FAIL_OR(fault_at_path("open", path), -1, NEXT(name)(path, flags, mode));                                           \
  }
OPEN(open)
OPEN(open64)

FILE* fopen(const char* path, const char* mode) {
  FAIL_OR(fault_at_path("open", path), NULL, NEXT(fopen)(path, mode));
}
FILE* fopen64(const char* path, const char* mode) {
  FAIL_OR(fault_at_path("open", path), NULL, NEXT(fopen64)(path, mode));
}
int mkostemp(char* path, int flags) { FAIL_OR(fault_at_path("open", path), -1, NEXT(mkostemp)(path, flags)); }
int mkostemp64(char* path, int flags) { FAIL_OR(fault_at_path("open", path), -1, NEXT(mkostemp64)(path, flags)); }

/* A call that moves bytes: all, some of them, or none. */
#define MOVE(word, size, failed, call)                                                                                 \
  do {                                                                                                                 \
    const int found = fault_at_file(word, file);                                                                       \
    if (found > 0) return errno = found, (failed);                                                                     \
    if (found == make_short && (size) > 1) (size) = 1;                                                                 \
    return call;                                                                                                       \
  } while (0)

ssize_t write(int file, const void* from, size_t size) { MOVE("write", size, -1, NEXT(write)(file, from, size)); }
ssize_t read(int file, void* to, size_t size) { MOVE("read", size, -1, NEXT(read)(file, to, size)); }
ssize_t pwrite(int file, const void* from, size_t size, off_t at) {
  MOVE("write", size, -1, NEXT(pwrite)(file, from, size, at));
}
ssize_t pread(int file, void* to, size_t size, off_t at) { MOVE("read", size, -1, NEXT(pread)(file, to, size, at)); }

/* libstdc++ writes large blocks so; short: of the first one, one byte. */
ssize_t writev(int file, const struct iovec* blocks, int count) {
  const int found = fault_at_file("write", file);
  if (found > 0) return errno = found, -1;
  if (found != make_short || blocks[0].iov_len == 0) return NEXT(writev)(file, blocks, count);
  return NEXT(write)(file, blocks[0].iov_base, 1);
}

int fsync(int file) { FAIL_OR(fault_at_file("fsync", file), -1, NEXT(fsync)(file)); }
int fdatasync(int file) { FAIL_OR(fault_at_file("fsync", file), -1, NEXT(fdatasync)(file)); }
int ftruncate(int file, off_t size) { FAIL_OR(fault_at_file("truncate", file), -1, NEXT(ftruncate)(file, size)); }
int truncate(const char* path, off_t size) { FAIL_OR(fault_at_path("truncate", path), -1, NEXT(truncate)(path, size)); }
int rename(const char* from, const char* to) { FAIL_OR(fault_at_path("rename", from), -1, NEXT(rename)(from, to)); }
int unlink(const char* path) { FAIL_OR(fault_at_path("unlink", path), -1, NEXT(unlink)(path)); }
int mkdir(const char* path, mode_t mode) { FAIL_OR(fault_at_path("mkdir", path), -1, NEXT(mkdir)(path, mode)); }
int flock(int file, int how) { FAIL_OR(fault_at_file("flock", file), -1, NEXT(flock)(file, how)); }

/* The file is closed all the same, as on a network drive that finds out too late. */
int close(int file) {
  const int flags = fcntl(file, F_GETFL);
  const int only_read = flags < 0 || (flags & O_ACCMODE) == O_RDONLY; // nothing can be lost of it
  const int found = only_read ? go_on : fault_at_file("close", file), closed = NEXT(close)(file);
  if (found > 0) return errno = found, -1;
  return closed;
}

/* It returns the error and leaves errno alone. */
int posix_fallocate(int file, off_t at, off_t size) {
  const int found = fault_at_file("allocate", file);
  return found > 0 ? found : NEXT(posix_fallocate)(file, at, size);
}
int posix_fallocate64(int file, off64_t at, off64_t size) {
  const int found = fault_at_file("allocate", file);
  return found > 0 ? found : NEXT(posix_fallocate64)(file, at, size);
}
/* A thread is of no file: it counts as a call on the folder itself. It returns the error and leaves errno alone. */
int pthread_create(pthread_t* thread, const pthread_attr_t* how, void* (*work)(void*), void* with) {
  const int found = fault_at("thread", getenv("FAULTS_PATH"));
  return found > 0 ? found : NEXT(pthread_create)(thread, how, work, with);
}
void* mmap(void* where, size_t size, int protection, int flags, int file, off_t at) {
  if (file >= 0) {
    const int found = fault_at_file("mmap", file);
    if (found > 0) return errno = found, MAP_FAILED;
  }
  return NEXT(mmap)(where, size, protection, flags, file, at);
}
