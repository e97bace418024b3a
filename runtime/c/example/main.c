/*
 * Runs the drive on rows of (velocity, position, load, temperature) from the file request.bin beside the emulator, and writes the
 * torques to answer.bin, both by semihosting. The two files are those of tests/firmware/harness/src/protocol.rs.
 */
#include "drive.h"

enum { SYS_OPEN = 0x01, SYS_WRITE = 0x05, SYS_READ = 0x06, SYS_EXIT_EXTENDED = 0x20, APPLICATION_EXIT = 0x20026 };
enum { READ_BINARY = 1, WRITE_BINARY = 5, INPUTS = 6, REQUEST_WORDS = 6, ANSWER_WORDS = 8 };
enum { START_STACK = 5, STEP_STACK = 6 };

#define MAGIC 0x514B5246u /* FRKQ */
#define REFUSED 0x100u

static uintptr_t call(uintptr_t operation, const uintptr_t *arguments) {
    register uintptr_t r0 __asm("r0") = operation;
    register const uintptr_t *r1 __asm("r1") = arguments;
    __asm volatile("bkpt #0xAB" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static _Noreturn void leave(uintptr_t status) {
    const uintptr_t arguments[] = {APPLICATION_EXIT, status};
    for (;;) call(SYS_EXIT_EXTENDED, arguments);
}

static uintptr_t open_file(const char *name, uintptr_t length, uintptr_t mode) {
    const uintptr_t arguments[] = {(uintptr_t)name, mode, length};
    return call(SYS_OPEN, arguments);
}

/* Reads or writes all bytes, or ends the emulation. */
static void transfer(uintptr_t operation, uintptr_t file, const void *bytes, uintptr_t length) {
    const uintptr_t arguments[] = {file, (uintptr_t)bytes, length};
    if (call(operation, arguments) != 0) leave(1);
}

#define PAINT 0xA5C33C5Au
#define INLINED static inline __attribute__((always_inline))

extern uint32_t _bss_end;

INLINED volatile uint32_t *stack_pointer(void) {
    volatile uint32_t *pointer;
    __asm volatile("mov %0, sp" : "=r"(pointer));
    return pointer;
}

/* Paints what lies between the static data and the stack. */
INLINED void paint(void) {
    for (volatile uint32_t *word = &_bss_end; word < stack_pointer(); word++) *word = PAINT;
}

/* Bytes of stack that were used since it was painted. */
INLINED uint32_t used_stack(void) {
    volatile uint32_t *word = &_bss_end;
    while (word < stack_pointer() && *word == PAINT) word++;
    return 4 * (uint32_t)(stack_pointer() - word);
}

void fault(void) { leave(101); }

int main(void) {
    uintptr_t request = open_file("request.bin", 11, READ_BINARY);
    uintptr_t answer = open_file("answer.bin", 10, WRITE_BINARY);
    uint32_t header[REQUEST_WORDS];
    transfer(SYS_READ, request, header, sizeof header);

    paint();
    FrikanStatus status = drive_start();
    uint32_t rows = header[4], result[ANSWER_WORDS] = {MAGIC, [START_STACK] = used_stack()};
    static const FrikanSample at_rest;
    paint();
    drive_step(&at_rest);
    result[STEP_STACK] = used_stack();
    if (header[0] != MAGIC || header[5] != INPUTS || status != FRIKAN_STATUS_ACTIVE) result[1] = REFUSED + status;
    transfer(SYS_WRITE, answer, result, sizeof result);
    if (result[1] != 0) leave(0);

    while (rows-- > 0) {
        float row[INPUTS];
        transfer(SYS_READ, request, row, sizeof row);
        FrikanSample sample = {
            .measurement = {.velocity = row[0], .position = row[1], .load = row[2], .temperature = row[3]},
            .reference_velocity = row[4],
            .loop_torque = row[5],
        };
        float torque = drive_step(&sample);
        transfer(SYS_WRITE, answer, &torque, sizeof torque);
    }
    leave(0);
}
