use super::*;

#[test]
fn driving_and_backdriving_become_mean_and_difference() {
    let mut terms = Terms::default();
    terms.add(EffectId::DriveBackdrive, &[2.0], &[0.3, 0.1], &Context::default()).unwrap();
    let Effect::Load { mean, difference, .. } = terms.effects[0] else { panic!("{:?}", terms.effects) };
    assert!((mean - 0.2).abs() < 1e-6 && (difference - 0.1).abs() < 1e-6);
    assert_eq!(terms.channels, [Quantity::Load]);
}

#[test]
fn every_element_of_presliding_is_written() {
    let mut terms = Terms::default();
    let context = Context { may_read_position: true, ..Context::default() };
    terms.add(EffectId::Presliding, &[2.0e-4, 3.0], &[1.5, 0.0, 0.25], &context).unwrap();
    let Effect::Presliding { elements, .. } = &terms.effects[0] else { panic!("{:?}", terms.effects) };
    let expected = [(1.5, 2.0e-4), (0.25, 3.2e-3)].map(|(torque, distance)| Element { torque, distance });
    assert_eq!(elements[..], expected);
    assert_eq!(terms.channels, [Quantity::Position]);
    assert!(terms.add(EffectId::Presliding, &[2.0e-4, 1.0], &[-1.0], &context).is_err());
}

#[test]
fn what_a_viscosity_and_a_load_friction_have_is_written() {
    let mut terms = Terms::default();
    terms.add(EffectId::Temperature, &[1.0, 30.0, 0.04], &[-0.2], &Context::default()).unwrap();
    let Effect::Temperature { viscous, decay, .. } = terms.effects[0] else { panic!("{:?}", terms.effects) };
    assert_eq!((viscous, decay), (-0.2, 0.04));
    terms.add(EffectId::LoadFriction, &[1.0, 0.1], &[0.0, 0.02], &Context::default()).unwrap();
    let Effect::Load { mean, stribeck, velocity, .. } = terms.effects[1] else { panic!("{:?}", terms.effects) };
    assert_eq!((mean, stribeck, velocity), (0.0, 0.02, 0.1));
}

#[test]
fn lines_of_one_ripple_share_a_term_and_a_lag_comes_first() {
    let mut terms = Terms::default();
    for order in 1..=6 {
        let shape = [f64::from(order), 0.0];
        terms.add(EffectId::PositionRipple, &shape, &[0.1, 0.2], &Context::default()).unwrap();
    }
    terms.add(EffectId::PositionRipple, &[1.0, 1.0], &[0.1, 0.2], &Context::default()).unwrap();
    terms.add(EffectId::FrictionalLag, &[0.01], &[1.0], &Context::default()).unwrap();
    let lines = terms.effects.iter().map(|effect| match effect {
        Effect::Ripple { harmonics, .. } => harmonics.len(),
        _ => 0,
    });
    assert_eq!(lines.collect::<Vec<_>>(), [0, 4, 2, 1]);
    assert!(matches!(terms.effects[0], Effect::FrictionalLag { .. }));
}

#[test]
fn a_kinematic_error_and_a_play_correct_the_position() {
    let mut terms = Terms::default();
    assert!(terms.add(EffectId::KinematicError, &[60.0], &[0.5, -0.25], &Context::default()).is_err());
    assert!(terms.effects.is_empty() && terms.channels.is_empty());
    terms.rigid_body.inertia = 2.0;
    terms.add(EffectId::KinematicError, &[60.0], &[0.5, -0.25], &Context::default()).unwrap();
    let Effect::Ripple { kind: Kind::Position, harmonics, .. } = &terms.effects[0] else {
        panic!("{:?}", terms.effects)
    };
    assert_eq!(harmonics[..], [Harmonic { order: 60.0, cosine: 0.25, sine: -0.125 }]);
    terms.add(EffectId::Backlash, &[1.0e-3, 0.4, 0.0], &[0.4], &Context::default()).unwrap();
    assert_eq!(terms.effects[1], Effect::Play { half_width: 1.0e-3, torque: 0.0 });
    assert_eq!(terms.channels, [Quantity::Position]);
}

#[test]
fn a_scale_corrects_every_rigid_body_parameter() {
    let mut terms = Terms::default();
    terms.rigid_body.inertia = 2.0;
    terms.add(EffectId::TorqueScale, &[], &[0.1], &Context::default()).unwrap();
    assert!((terms.rigid_body.inertia - 2.2).abs() < 1e-6 && (terms.rigid_body.given_scale - 1.1).abs() < 1e-6);
    assert!(terms.effects.is_empty());
}

#[test]
fn faults_are_not_compensated() {
    assert!(Terms::default().add(EffectId::Contact, &[0.0, 1.0], &[9.0], &Context::default()).is_err());
    assert!(Terms::default().add(EffectId::TimeMisalignment, &[], &[0.01], &Context::default()).is_err());
}

#[test]
fn the_table_over_position_is_its_series() {
    let mut terms = Terms { first_cell: 3, ..Terms::default() };
    terms.add(EffectId::PositionFriction, &[3.0, -1.0, 1.0], &[0.5, -0.2, 0.1], &Context::default()).unwrap();
    assert_eq!(terms.cells.len(), usize::from(POSITION_CELLS));
    // The coordinate of a cell runs from one to two.
    let start: f32 = terms.cells[0].floats().iter().sum();
    assert!((start - (0.5 - 0.2 + 0.1)).abs() < 1e-4, "{start}");
}

#[test]
fn what_has_no_room_is_refused_and_leaves_nothing_behind() {
    let context = Context { may_read_position: true, ..Context::default() };
    let mut full = Terms::default();
    for _ in 0..MAX_EFFECTS {
        full.add(EffectId::ViscousNonlinearity, &[1.5], &[0.1], &context).unwrap();
    }
    assert!(full.add(EffectId::ViscousNonlinearity, &[1.5], &[0.1], &context).is_err());
    assert_eq!(full.effects.len(), MAX_EFFECTS);

    let inputs = vec![Quantity::Velocity, Quantity::Temperature];
    let mut narrow = Terms { inputs, room: Room { channels: 2, cells: 128 }, ..Terms::default() };
    narrow.add(EffectId::Temperature, &[1.0, 30.0, 0.0], &[-0.2], &context).unwrap();
    assert!(narrow.add(EffectId::Spring, &[], &[1.0], &context).is_err());
    assert_eq!((narrow.effects.len(), narrow.channels.len()), (1, 0));

    let mut small = Terms { first_cell: 100, ..Terms::default() };
    let position_friction = [0.0, -1.0, 1.0];
    small.add(EffectId::PositionFriction, &position_friction, &[0.3, 0.1], &context).unwrap();
    assert!(!small.lacks_cells);
    assert!(small.add(EffectId::PositionFriction, &position_friction, &[0.3, 0.1], &context).is_err());
    assert_eq!((small.effects.len(), small.cells.len(), small.lacks_cells), (1, usize::from(POSITION_CELLS), true));
}
