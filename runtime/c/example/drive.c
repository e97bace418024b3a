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

static FrikanCompensator elbow;

FrikanStatus drive_start(void) {
    return frikan_start(&elbow, _image_start, (size_t)(_image_end - _image_start), KEY, &limits);
}

float drive_step(const FrikanMeasurement *measurement) {
    /* Zero unless the status is FRIKAN_STATUS_ACTIVE. */
    return frikan_step(&elbow, measurement, PERIOD_S).torque;
}
