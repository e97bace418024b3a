// A joint whose friction is compensated within limits. elbow.h: trainer export elbow.frk --to c-header -o elbow.h
#include <frikan.h>

#include "elbow.h"

static FrikanCompensator elbow;
static FrikanSupervisor watch;

// To be written for the board: velocity and position of the joint, those of the reference, and the torque of the controller.
static FrikanSample measured() {
  FrikanSample sample = {};
  sample.measurement = frikan_no_measurement();
  sample.reference_velocity = NAN;
  return sample;
}

static void put_out(float torque) { (void)torque; }

void setup() {
  const FrikanLimits limits = {0.9f, 40.0f, 8000.0f, 0.0f};
  const FrikanSupervision settings = frikan_supervision(0.5f, 2.0f, 6.2831853f / 1048576.0f);
  frikan_supervise(&watch, &settings);
  frikan_start(&elbow, elbow_image, ELBOW_IMAGE_BYTES, NULL, &limits);
}

void loop() {
  static uint32_t next = micros();
  while ((int32_t)(micros() - next) < 0) {
  }
  next += 1000;
  const FrikanSample sample = measured();
  put_out(frikan_supervised_step(&watch, &elbow, &sample, 0.001f).torque);
}
