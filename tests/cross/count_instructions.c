/* A plugin for QEMU's user-mode emulation that counts the instructions of every frame that replay_frames
 * processes, by stage. Counts repeat exactly.
 *
 *   qemu-aarch64 -plugin libcount_instructions.so,out=FILE -L SYSROOT replay_frames MODEL RECORDING
 *
 * Writes one line a frame: number, state (0 searching, 1 tracking, 2 lost), instructions in all, then the
 * instructions of each stage in the order of pliant::Stage. Debian has no header for plugins: what is used of
 * the interface, version 1 (QEMU 6.0 to 8), is declared here from its documentation. */
#include <inttypes.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

typedef uint64_t qemu_plugin_id_t;
struct qemu_plugin_tb;
struct qemu_info;
enum qemu_plugin_op { QEMU_PLUGIN_INLINE_ADD_U64 };
typedef void (*translated_callback)(qemu_plugin_id_t, struct qemu_plugin_tb*);
typedef void (*ended_callback)(qemu_plugin_id_t, void*);
typedef void (*syscall_callback)(qemu_plugin_id_t, unsigned int, int64_t, uint64_t, uint64_t, uint64_t,
                                 uint64_t, uint64_t, uint64_t, uint64_t, uint64_t);
void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t, translated_callback);
void qemu_plugin_register_vcpu_tb_exec_inline(struct qemu_plugin_tb*, enum qemu_plugin_op, void*, uint64_t);
void qemu_plugin_register_vcpu_syscall_cb(qemu_plugin_id_t, syscall_callback);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t, ended_callback, void*);
size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb*);

#define EXPORTED __attribute__((visibility("default")))
EXPORTED int qemu_plugin_version = 1;
EXPORTED int qemu_plugin_install(qemu_plugin_id_t id, const struct qemu_info* info, int count, char** words);

enum { kStages = 8 };
static const uint32_t kMark = 0x504C4E54;      /* first argument of a marked call */
enum { kFrameBegins, kStageDone, kFrameDone }; /* second argument */

static uint64_t executed;
static uint64_t frame, frame_start, last;
static uint64_t stages[kStages];
static FILE* out;

static void on_translated(qemu_plugin_id_t id, struct qemu_plugin_tb* block) {
  (void)id;
  qemu_plugin_register_vcpu_tb_exec_inline(block, QEMU_PLUGIN_INLINE_ADD_U64, &executed,
                                           qemu_plugin_tb_n_insns(block));
}

static void on_syscall(qemu_plugin_id_t id, unsigned int cpu, int64_t number, uint64_t mark, uint64_t what,
                       uint64_t value, uint64_t a4, uint64_t a5, uint64_t a6, uint64_t a7, uint64_t a8) {
  (void)id, (void)cpu, (void)number, (void)a4, (void)a5, (void)a6, (void)a7, (void)a8;
  if ((uint32_t)mark != kMark) return;
  if (what == kFrameBegins) {
    frame = value;
    memset(stages, 0, sizeof stages);
    frame_start = executed;
  } else if (what == kStageDone && value < kStages) {
    stages[value] += executed - last;
  } else if (what == kFrameDone) {
    fprintf(out, "%" PRIu64 " %" PRIu64 " %" PRIu64, frame, value, executed - frame_start);
    for (int i = 0; i < kStages; ++i) fprintf(out, " %" PRIu64, stages[i]);
    fputc('\n', out);
  }
  last = executed;
}

static void on_end(qemu_plugin_id_t id, void* data) {
  (void)id, (void)data;
  fprintf(out, "# %" PRIu64 " in all\n", executed);
  fclose(out);
}

int qemu_plugin_install(qemu_plugin_id_t id, const struct qemu_info* info, int count, char** words) {
  (void)info;
  for (int i = 0; i < count; ++i)
    if (strncmp(words[i], "out=", 4) == 0) out = fopen(words[i] + 4, "w");
  if (out == NULL) {
    fprintf(stderr, "count_instructions: say out=FILE, in a place that can be written\n");
    return 1;
  }
  qemu_plugin_register_vcpu_tb_trans_cb(id, on_translated);
  qemu_plugin_register_vcpu_syscall_cb(id, on_syscall);
  qemu_plugin_register_atexit_cb(id, on_end, NULL);
  return 0;
}
