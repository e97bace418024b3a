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

/* Speeds at which the friction of the image is asked, the latter next to the fastest of the reference; and how far it may be from that of this
 * joint, as a factor: a compensation of twice the friction or of half of it says nothing of the image. */
#define SLOW_RAD_S 0.5f
#define FAST_RAD_S 1.2f
#define MOST_FACTOR 2.0f
#define ASKED_SAMPLES 100

/* The position loop, N m/rad and N m s/rad. */
#define STIFFNESS 300.0f
#define DAMPING 20.0f

/* The reference: 0.4 rad at 0.5 Hz, turned by its angle of a sample. */
#define AMPLITUDE_RAD 0.4f
#define OMEGA_RAD_S 3.1415927f
#define COSINE 0.99999507f
#define SINE 0.0031415875f

/* Defined by the linker script: the flash that is kept for the image. */
extern const uint8_t _image_start[], _image_end[];

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

/* A number with two decimals, as large as they leave room for. */
static void print_number(float number) {
    char digits[12];
    char *at = digits + sizeof digits - 1;
    uint32_t hundredths = number < 4e7f ? (uint32_t)(100.0f * number + 0.5f) : UINT32_MAX;
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

/* Friction of the joint, N m. */
static float friction_at(float speed) {
    const float peak = speed / STRIBECK_RAD_S;
    return COULOMB_NM + STRIBECK_NM / (1.0f + peak * peak) + VISCOUS_NMS_RAD * speed;
}

/* A step of the joint: what friction may take of the velocity, it takes at most to rest. */
static float next_velocity(float velocity, float torque, float dt) {
    const float friction = friction_at(magnitude(velocity));
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

/* The status of an image that the drive refuses, and what to do. */
static void tell_refusal(FrikanStatus status) {
    const char digits[] = {(char)('0' + status / 10 % 10), (char)('0' + status % 10), 0};
    print("the drive refuses the image, status ");
    print(digits);
    switch (status) {
    case FRIKAN_STATUS_NOT_BUILT_IN:
        print(": this library reads tables over velocity: fit with --representation table, or take the law as source (trainer export --to c)\n");
        break;
    case FRIKAN_STATUS_TOO_LARGE:
        print(": it has more cells than this library: fit with --max-bytes\n");
        break;
    case FRIKAN_STATUS_MISSING_CHANNEL:
        print(": it reads what this drive does not measure: fit with --inputs velocity\n");
        break;
    case FRIKAN_STATUS_OTHER_UNIT:
        print(": this drive commands N m, the image is in another unit\n");
        break;
    default:
        print(": frikan.h says what it means, trainer show what the image holds\n");
    }
}

/* Whether the friction of the image at a speed is that of this joint, roughly; says so where it is not. */
static int is_of_this_joint(float speed) {
    static FrikanCompensator asked;
    const FrikanLimits none = {.gain = 1.0f, .torque = 1e9f, .slew = 1e15f};
    const FrikanMeasurement moving = {.velocity = speed};
    frikan_start(&asked, _image_start, (size_t)(_image_end - _image_start), 0, &none);
    float friction = 0.0f;
    for (int sample = 0; sample < ASKED_SAMPLES; sample++) friction = frikan_step(&asked, &moving, PERIOD_S).torque;
    const float own = friction_at(speed);
    if (friction > own / MOST_FACTOR && friction < own * MOST_FACTOR) return 1;
    print("the image is of a joint of another size: at ");
    print_number(speed);
    print(" rad/s its friction is ");
    if (friction < 0.0f) print("-");
    print_number(magnitude(friction));
    print(" N m, that of the joint simulated here ");
    print_number(own);
    print(" N m; trainer loop JOINT.toml --image MODEL.frk simulates its own\n");
    return 0;
}

void fault(void) {
    print("fault\n");
    leave(101);
}

int main(void) {
    const FrikanStatus status = drive_start();
    if (status != FRIKAN_STATUS_ACTIVE) {
        tell_refusal(status);
        leave(1);
    }
    if (!is_of_this_joint(SLOW_RAD_S) || !is_of_this_joint(FAST_RAD_S)) leave(1);
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
