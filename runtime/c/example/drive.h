/* What a drive does with Frikan. */
#ifndef DRIVE_H
#define DRIVE_H

#include "frikan.h"

/* Reads the image in flash. Compensation is off where the status is not FRIKAN_STATUS_ACTIVE. */
FrikanStatus drive_start(void);

/* The servo interrupt, every millisecond: the torque to add to the controller's. */
float drive_step(const FrikanSample *sample);

#endif
