//! One evaluation of loss and gradient on one thread, against samples, nodes, inputs and cells.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use frikan_tests::training_cost::{CELLS, EVALUATIONS, Evaluation, GROUP, with_cells};
use frikan_trainer::kan::{Blocks, Dataset, loss_and_gradient};

fn evaluations(criterion: &mut Criterion) {
    // The first pool of a process is the one that is used: one thread, so that figures are those of one core.
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("no pool yet");
    let mut group = criterion.benchmark_group(GROUP);
    group.sample_size(20);
    let shapes = EVALUATIONS.map(|(shape, samples)| (shape.parse().expect("a shape"), shape.to_owned(), samples));
    let cells = CELLS.map(|cells| (with_cells(cells), format!("{cells} cells"), 10_000));
    for (architecture, name, samples) in shapes.into_iter().chain(cells) {
        let evaluation = Evaluation::new(&architecture, samples);
        let blocks = Blocks::default();
        let data = Dataset { inputs: &evaluation.inputs, target: &evaluation.target, linear: &[], blocks: &blocks };
        group.bench_function(BenchmarkId::new(name, samples), |bencher| {
            bencher.iter(|| loss_and_gradient(&evaluation.network, &[], &data).expect("usable samples"));
        });
    }
    group.finish();
}

criterion_group!(benches, evaluations);
criterion_main!(benches);
