#include "drive.h"

/* Defined by the linker script: the flash that is kept for the image. */
extern const uint8_t _image_start[], _image_end[];

#define PERIOD_S 0.001f

/* 90 % of the friction, never more than 40 N m, never faster than 8 kN m/s: no image changes that. */
static const FrikanLimits limits = {.gain = 0.9f, .torque = 40.0f, .slew = 8000.0f};

#ifdef DRIVE_KEY
/* A real drive reads its key from protected memory. */
static const uint8_t secret[FRIKAN_KEY_BYTES] = {DRIVE_KEY};
#define KEY secret
#else
#define KEY ((const uint8_t *)0)
#endif

/* Torques in N m, from what this drive measures. A drive that keeps a number of its own asks for the joint and the least release as well. */
static const FrikanTrust trust = {
    .key = KEY,
    .unit = FRIKAN_UNIT_NEWTON_METRE,
    .channels = FRIKAN_CHANNEL_VELOCITY | FRIKAN_CHANNEL_POSITION | FRIKAN_CHANNEL_LOAD | FRIKAN_CHANNEL_TEMPERATURE,
};

/* Inertia and friction of the joint, roughly: what the supervisor compares with; and what a count of its encoder of 20 bits is. */
#define INERTIA_KGM2 0.5f
#ifndef FRICTION_NM
#define FRICTION_NM 20.0f
#endif
#define COUNT_RAD (6.2831853f / 1048576.0f)

static FrikanCompensator elbow;
static FrikanSupervisor watch;

FrikanStatus drive_start(void) {
    /* A library built with other features than this file. */
    if (frikan_compensator_bytes() != sizeof elbow) return FRIKAN_STATUS_NOT_STARTED;
    const FrikanSupervision settings = frikan_supervision(INERTIA_KGM2, FRICTION_NM, COUNT_RAD);
    FrikanStatus status = frikan_supervise(&watch, &settings);
    if (status != FRIKAN_STATUS_ACTIVE) return status;
    return frikan_start(&elbow, _image_start, (size_t)(_image_end - _image_start), &trust, &limits);
}

float drive_step(const FrikanSample *sample) {
    /* Supervised: the bare frikan_step at a measured velocity switches its torque at rest, and the joint hunts. */
    return frikan_supervised_step(&watch, &elbow, sample, PERIOD_S).torque;
}
