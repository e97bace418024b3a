/*
 * A joint in closed loop, without and with the compensation of drive.c: on the emulated Cortex-M4F both are simulated here, and the tracking
 * errors are printed. The joint is that of fixtures/elbow.toml without gravity; its friction is written anew, so that the law in the image is not its
 * own.
 */
#include "drive.h"

enum { SYS_WRITE0 = 0x04, SYS_EXIT_EXTENDED = 0x20, APPLICATION_EXIT = 0x20026 };

/* A sample of the drive is a millisecond; the joint is stepped twenty times in it. */
#define PERIOD_S 0.001f
#define SUBSTEPS 20
#define SAMPLES 20000
/* What is tracked before errors count: a period of the reference. */
#define SETTLING 2000

#define INERTIA_KGM2 0.5f
#define COULOMB_NM 2.0f
#define STRIBECK_NM 1.0f
#define STRIBECK_RAD_S 0.1f
#define VISCOUS_NMS_RAD 1.2f
#define COUNT_RAD (6.2831853f / 1048576.0f)

/* The position loop, N m/rad and N m s/rad. */
#define STIFFNESS 300.0f
#define DAMPING 20.0f

/* The reference: 0.4 rad at 0.5 Hz, turned by its angle of a sample. */
#define AMPLITUDE_RAD 0.4f
#define OMEGA_RAD_S 3.1415927f
#define COSINE 0.99999507f
#define SINE 0.0031415875f

static uintptr_t call(uintptr_t operation, const void *arguments) {
    register uintptr_t r0 __asm("r0") = operation;
    register const void *r1 __asm("r1") = arguments;
    __asm volatile("bkpt #0xAB" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static void print(const char *text) { call(SYS_WRITE0, text); }

static _Noreturn void leave(uintptr_t status) {
    const uintptr_t arguments[] = {APPLICATION_EXIT, status};
    for (;;) call(SYS_EXIT_EXTENDED, arguments);
}

/* A number with two decimals. */
static void print_number(float number) {
    char digits[12];
    char *at = digits + sizeof digits - 1;
    uint32_t hundredths = (uint32_t)(100.0f * number + 0.5f);
    *at = 0;
    for (int place = 0; place < 3 || hundredths > 0; place++, hundredths /= 10) {
        if (place == 2) *--at = '.';
        *--at = (char)('0' + hundredths % 10);
    }
    print(at);
}

static float magnitude(float x) { return x < 0.0f ? -x : x; }

static float root(float x) {
    float y;
    __asm("vsqrt.f32 %0, %1" : "=t"(y) : "t"(x));
    return y;
}

/* A step of the joint: what friction may take of the velocity, it takes at most to rest. */
static float next_velocity(float velocity, float torque, float dt) {
    const float peak = velocity / STRIBECK_RAD_S;
    const float friction = COULOMB_NM + STRIBECK_NM / (1.0f + peak * peak) + VISCOUS_NMS_RAD * magnitude(velocity);
    const float free = velocity + dt * torque / INERTIA_KGM2, most = dt * friction / INERTIA_KGM2;
    if (magnitude(free) <= most) return 0.0f;
    return free > 0.0f ? free - most : free + most;
}

/* Root mean square of the tracking error, mrad, with so much of the compensation. */
static float tracking_error(float share) {
    float position = 0.0f, velocity = 0.0f, before = 0.0f, loop_torque = 0.0f, squares = 0.0f;
    float x = 1.0f, y = 0.0f;
    for (int sample = 0; sample < SAMPLES; sample++) {
        const float measured = COUNT_RAD * (float)(int32_t)(position / COUNT_RAD);
        const float reference = AMPLITUDE_RAD * y, reference_velocity = AMPLITUDE_RAD * OMEGA_RAD_S * x;
        const FrikanSample now = {
            .measurement = {.velocity = (measured - before) / PERIOD_S, .position = measured},
            .reference_velocity = reference_velocity,
            .loop_torque = loop_torque,
        };
        const float compensation = share * drive_step(&now);
        before = measured;
        loop_torque = STIFFNESS * (reference - measured) + DAMPING * (reference_velocity - now.measurement.velocity)
                      - INERTIA_KGM2 * OMEGA_RAD_S * OMEGA_RAD_S * reference;
        for (int step = 0; step < SUBSTEPS; step++) {
            velocity = next_velocity(velocity, loop_torque + compensation, PERIOD_S / SUBSTEPS);
            position += velocity * (PERIOD_S / SUBSTEPS);
        }
        const float next = x * COSINE - y * SINE;
        y = x * SINE + y * COSINE;
        x = next;
        if (sample >= SETTLING) {
            const float error = 1000.0f * (AMPLITUDE_RAD * y - position);
            squares += error * error / (SAMPLES - SETTLING);
        }
    }
    return root(squares);
}

void fault(void) {
    print("fault\n");
    leave(101);
}

int main(void) {
    const FrikanStatus status = drive_start();
    if (status != FRIKAN_STATUS_ACTIVE) {
        print("the drive refuses the image\n");
        leave(1);
    }
    const float without = tracking_error(0.0f);
    drive_start();
    const float with = tracking_error(1.0f);
    print("tracking error (RMS): ");
    print_number(without);
    print(" mrad without compensation, ");
    print_number(with);
    print(" mrad with it\n");
    leave(0);
}
