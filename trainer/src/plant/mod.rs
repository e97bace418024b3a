//! A simulated joint in closed loop. Shares no equations with the diagnosis.
