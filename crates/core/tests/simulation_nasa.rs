//! Checks NASA's 6-DOF orbital check-cases through [`Simulation`]: 8 h with steps of 1 s.
//!
//! Source: NASA/TM-2015-218675 numbering, values of JEOD's SIM_dyncomp verification logs, as typed
//! in `validation/nasa_orbital/states.csv`. Gates: 1e-4 m, 1e-7 m/s, 1e-12 rad/s, 1e-7 deg; 1e-3 m
//! for 6C, which ends 9860 km from its reference (and whose end of burn is inferred).
#![allow(clippy::unwrap_used, clippy::print_stdout)] // set-up that fails should stop; --nocapture shows the numbers
#![allow(clippy::excessive_precision)] // the numbers as the source prints them

mod common;

use common::spacecraft::{Craft, Independent, Pull, State};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use onorbit_core::environment::{BodyWrench, GravityGradient};
use onorbit_core::model::Model;
use onorbit_core::orbit::Kepler;
use onorbit_core::simulation::{Simulation, Trace};
use std::sync::Arc;

/// μ of GGM02C, m³/s²: a relative error of 3e-7 shifts run 2 by 0.3 m after 8 h.
const MU: f64 = 3.986004415e14;
/// Rate of the local frame of the typical orbit, rad/s.
const RATE: f64 = 1.134454274550824e-3;

const TYPICAL: [[f64; 3]; 2] = [[-4292653.41, 955168.47, 5139356.57], [109.649663, -7527.72649, 1484.521489]];
const ELLIPTICAL: [[f64; 3]; 2] =
    [[-4315967.74, 960356.20, 5167269.53], [129.091037, -7491.513855, 1452.515654]];

/// Inertial to body components at the start: pitched by -11.6 deg from LVLH.
const PITCHED: [f64; 9] = [
    0.1412307175854335,
    -0.9892782736897275,
    0.03718039289432368,
    -0.772691975098125,
    -0.1336331223242703,
    -0.6205556383087864,
    0.6188707425862547,
    0.05891252687959725,
    -0.7832804849780175,
];
const GRADIENT_TYPICAL: [f64; 9] = [
    -0.6443912270931274,
    0.05284210190675609,
    0.7628680480341864,
    -0.7615617871470506,
    -0.1345758407161209,
    -0.6339660776454052,
    0.06916350883930189,
    -0.9894933326514259,
    0.1269620166955875,
];
const GRADIENT_ELLIPTICAL: [f64; 9] = [
    -0.6443912269484258,
    0.0528421023505859,
    0.762868048125672,
    -0.7615617871967408,
    -0.1345758406652156,
    -0.6339660774765135,
    0.0691635085403311,
    -0.9894933326346473,
    0.1269620169892195,
];

/// A state of a table: time, s; position, m; velocity, m/s; rate, rad/s; inertial to body, row major.
struct Row(f64, [f64; 3], [f64; 3], [f64; 3], [f64; 9]);

/// The Space Station, a cylinder of 1000 kg, a sphere of 1 kg. Source: `nasa_orbital/README.md`.
fn station() -> Craft {
    let i = Matrix3::new(1.02e8, -6.96e6, -5.48e6, -6.96e6, 0.91e8, 5.9e5, -5.48e6, 5.9e5, 1.64e8);
    Craft { mass: 400_000.0, inertia: i }
}
fn cylinder() -> Craft {
    Craft { mass: 1000.0, inertia: Matrix3::from_diagonal(&Vector3::new(500.0, 12250.0, 12250.0)) }
}
fn sphere() -> Craft {
    Craft { mass: 1.0, inertia: Matrix3::identity() * 0.4 }
}

struct Case {
    craft: Craft,
    orbit: [[f64; 3]; 2],
    rot_bi: Matrix3<f64>,
    rate: Vector3<f64>,
    pull: Pull,
}

impl Case {
    fn new(craft: Craft, orbit: [[f64; 3]; 2], rot_bi: &[f64; 9], rate: [f64; 3]) -> Self {
        let rot_bi = Matrix3::from_row_slice(rot_bi);
        Self { craft, orbit, rot_bi, rate: Vector3::from(rate), pull: Pull::default() }
    }

    fn with(mut self, pull: Pull) -> Self {
        self.pull = pull;
        self
    }

    fn simulate(&self) -> Trace {
        let model = Model::rigid_body(self.craft.mass, self.craft.inertia).unwrap();
        let mut q = vec![0.0; 7];
        let attitude =
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(self.rot_bi.transpose()));
        q[3..].copy_from_slice(attitude.coords.as_slice());
        let mut v = vec![0.0; 6];
        v[3..].copy_from_slice(self.rate.as_slice());
        let mut simulation = Simulation::new(Arc::new(model), q, v);
        let [r0, v0] = self.orbit.map(Vector3::from);
        simulation.orbit = Some(Arc::new(Kepler::from_state(r0, v0, MU).unwrap()));
        if self.pull.gradient {
            simulation.effects.push(Arc::new(GravityGradient));
        }
        let wrench = BodyWrench::new(0, self.pull.force, self.pull.torque).unwrap();
        let (start, end) = self.pull.during;
        if start < end {
            simulation.effects.push(Arc::new(wrench.during(start, end).unwrap()));
        }
        simulation.time_step = 1.0;
        simulation.record_every = 60;
        simulation.run(28_800.0).unwrap().only()
    }

    /// The same by an independent integration in absolute coordinates.
    fn independent(&self) -> State {
        let [position, velocity] = self.orbit.map(Vector3::from);
        let rot_ib = Rotation3::from_matrix_unchecked(self.rot_bi.transpose());
        let attitude = *UnitQuaternion::from_rotation_matrix(&rot_ib).quaternion();
        let start = State { position, velocity, attitude, rate: self.rate };
        Independent { craft: &self.craft, mu: MU, pull: &self.pull }.run(start, 28_800.0, 1.0)
    }
}

/// Returns the errors of a trace at a row of a table: m, m/s, rad/s, degrees.
fn errors(trace: &Trace, row: &Row) -> [f64; 4] {
    let k = trace.time.iter().position(|t| *t == row.0).unwrap();
    let three = |column: &[f64], from: usize| Vector3::from_column_slice(&column[from..from + 3]);
    let q = &trace.q[7 * k + 3..7 * k + 7];
    let attitude = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q[3], q[0], q[1], q[2]));
    let expected = Matrix3::from_row_slice(&row.4).transpose();
    // sine of the angle between the attitudes: the skew part of the matrix between them
    let between = attitude.to_rotation_matrix().into_inner() * expected.transpose();
    let skew = (between - between.transpose()) * 0.5;
    [
        (three(&trace.position_eci, 3 * k) - Vector3::from(row.1)).norm(),
        (three(&trace.velocity_eci, 3 * k) - Vector3::from(row.2)).norm(),
        (three(&trace.v, 6 * k + 3) - Vector3::from(row.3)).norm(),
        Vector3::new(skew[(2, 1)], skew[(0, 2)], skew[(1, 0)]).norm().to_degrees(),
    ]
}

fn assert_case(name: &str, case: &Case, rows: &[Row], position_gate: f64) {
    let trace = case.simulate();
    let gates = [position_gate, 1e-7, 1e-12, 1e-7];
    let end = case.independent();
    let rot_bi = end.attitude_matrix().transpose();
    let end = Row(28_800.0, end.position.into(), end.velocity.into(), end.rate.into(), row_major(&rot_bi));
    for (source, row) in rows.iter().map(|row| ("NASA", row)).chain([("independent", &end)]) {
        let found = errors(&trace, row);
        println!("{name} {source} at {} s: {found:?} (m, m/s, rad/s, deg)", row.0);
        assert!(found.iter().zip(gates).all(|(e, gate)| *e < gate), "{name} {source} {} s: {found:?}", row.0);
    }
}

fn row_major(m: &Matrix3<f64>) -> [f64; 9] {
    std::array::from_fn(|i| m[(i / 3, i % 3)])
}

/// Inertial to the nadir-pointing local frame: z = -r, y = -h, x = y × z.
fn nadir(orbit: &[[f64; 3]; 2]) -> [f64; 9] {
    let [r, v] = orbit.map(Vector3::from);
    let (z, y) = (-r.normalize(), -r.cross(&v).normalize());
    row_major(&Matrix3::from_columns(&[y.cross(&z), y, z]).transpose())
}

fn push(force: [f64; 3], torque: [f64; 3], start: f64, end: f64) -> Pull {
    Pull { force: force.into(), torque: torque.into(), during: (start, end), gradient: false }
}

fn gradient() -> Pull {
    Pull { gradient: true, ..Pull::default() }
}

#[test]
fn run_2_the_station_tumbles_on_its_orbit() {
    let rows = [
        Row(
            300.0,
            [-4013924.982713786, -1314597.200719335, 5281075.779524183],
            [1730.749311091039, -7457.525692534655, -549.126684931067],
            [-5.106463907717681e-06, -0.001134509943563471, -1.660053348917274e-05],
            [
                0.3415658073139367,
                -0.9125430205269727,
                -0.2249400697107739,
                -0.7723818914715976,
                -0.1361788701315136,
                -0.6203882083473713,
                0.5354988450041099,
                0.3856430357431772,
                -0.7513457499593983,
            ],
        ),
        Row(
            28500.0,
            [-2358900.657173204, -4914004.285973477, 3995415.061344395],
            [4074.658856790875, -5166.091146226869, -3961.119935227975],
            [-0.0007715374230276776, -0.0008142163821323106, -0.000195705821138628],
            [
                -0.09231168686955804,
                -0.1925953554020766,
                -0.9769265998757761,
                -0.9511698798375114,
                -0.2731620315098808,
                0.1437301785683481,
                -0.2945410194814825,
                0.9424911318516176,
                -0.1579748531376632,
            ],
        ),
        Row(
            28800.0,
            [-1024262.411095882, -6151093.565368023, 2599975.06217899],
            [4736.659484718068, -3000.74587812336, -5251.712385533817],
            [-0.0007963417068132182, -0.0007912816280812424, -0.0001860246400745597],
            [
                -0.1339788922977088,
                0.04980207610342591,
                -0.9897319887901309,
                -0.8654000972087016,
                -0.4924947721337001,
                0.09236650460066564,
                -0.4828377866010997,
                0.8688893212813491,
                0.109082625533986,
            ],
        ),
    ];
    assert_case("2", &Case::new(station(), TYPICAL, &PITCHED, [0.0, -RATE, 0.0]), &rows, 1e-4);
}

#[test]
fn run_6c_a_burn_out_of_plane_leads_far_from_the_reference() {
    let rows = [Row(
        28800.0,
        [-5139747.505466631, 2725307.63391457, 3824637.241792666],
        [-1022.728747378796, -6859.769327921018, 3059.867246101126],
        [0.0, -0.001134454274550824, 0.0],
        [
            0.6078134150884688,
            -0.4376712285502403,
            -0.6625758433098939,
            -0.7726919750981079,
            -0.1336331222642664,
            -0.6205556383088087,
            0.1830572698842595,
            0.8891490787922975,
            -0.4194090504809478,
        ],
    )];
    let case = Case::new(cylinder(), TYPICAL, &nadir(&TYPICAL), [0.0, -RATE, 0.0]);
    assert_case("6C", &case.with(push([0.0, -29000.0, 0.0], [0.0; 3], 1000.0, 1048.0)), &rows, 1e-3);
}

#[test]
fn run_8a_a_sphere_at_rest_in_inertial_space() {
    let rows = [Row(
        28800.0,
        [-1024262.411095882, -6151093.565368023, 2599975.06217899],
        [4736.659484718068, -3000.74587812336, -5251.712385533817],
        [0.0, 0.0, 0.0],
        [
            0.1412307175854335,
            -0.9892782736897275,
            0.03718039289432368,
            -0.772691975098125,
            -0.1336331223242703,
            -0.6205556383087864,
            0.6188707425862547,
            0.05891252687959725,
            -0.7832804849780175,
        ],
    )];
    assert_case("8A", &Case::new(sphere(), TYPICAL, &PITCHED, [0.0; 3]), &rows, 1e-4);
}

#[test]
fn run_9a_a_torque_for_a_thousand_seconds() {
    let rows = [Row(
        28800.0,
        [-1024262.411095882, -6151093.565368023, 2599975.06217899],
        [4736.659484718068, -3000.74587812336, -5251.712385533817],
        [9.751635347691358e-05, 8.882593782196596e-06, 1.53007486831241e-05],
        [
            0.1690520479948245,
            -0.9727191068763098,
            -0.1588676939673716,
            0.9656730014585525,
            0.1312128771193781,
            0.2241848235989362,
            -0.1972233741796006,
            -0.191313146427029,
            0.9615103851136525,
        ],
    )];
    let case = Case::new(station(), TYPICAL, &PITCHED, [0.0; 3]);
    assert_case("9A", &case.with(push([0.0; 3], [10.0, 0.0, 0.0], 1000.0, 2000.0)), &rows, 1e-4);
}

#[test]
fn run_9c_a_torque_and_a_force() {
    let rows = [Row(
        28800.0,
        [-1024344.851005548, -6151032.154589829, 2600064.501242927],
        [4736.639771390265, -3000.913213791366, -5251.651821855541],
        [9.751635347691358e-05, 8.882593782196596e-06, 1.53007486831241e-05],
        [
            0.1690520479948245,
            -0.9727191068763098,
            -0.1588676939673716,
            0.9656730014585525,
            0.1312128771193781,
            0.2241848235989362,
            -0.1972233741796006,
            -0.191313146427029,
            0.9615103851136525,
        ],
    )];
    let case = Case::new(station(), TYPICAL, &PITCHED, [0.0; 3]);
    assert_case("9C", &case.with(push([10.0, 0.0, 0.0], [10.0, 0.0, 0.0], 1000.0, 2000.0)), &rows, 1e-4);
}

#[test]
fn run_10a_a_cylinder_librates_in_the_gravity_gradient() {
    let rows = [
        Row(
            300.0,
            [-4013924.982713786, -1314597.200719335, 5281075.779524183],
            [1730.749311091039, -7457.525692534655, -549.126684931067],
            [-1.97989570839746e-05, -0.001042888574458625, -2.40799696123295e-05],
            [
                -0.5861515024150195,
                -0.2666556032407258,
                0.7650628768127101,
                -0.7648570200749972,
                -0.1293549559252893,
                -0.6310792614399254,
                0.2672454958621582,
                -0.9550717693649473,
                -0.1281318083205654,
            ],
        ),
        Row(
            480.0,
            [-3621015.185932965, -2620265.548797701, 5073007.878975903],
            [2619.787499360686, -6999.321089487831, -1754.794540015393],
            [-1.97989570839746e-05, -0.001000544885120127, -3.506849981351568e-05],
            [
                -0.5236151409762531,
                -0.4359892575327315,
                0.7319429974092768,
                -0.7689726505508485,
                -0.1279830312506458,
                -0.6263396893193816,
                0.3667536596207617,
                -0.8908050914919348,
                -0.2682499620257653,
            ],
        ),
        Row(
            28800.0,
            [-1024262.411095882, -6151093.565368023, 2599975.06217899],
            [4736.659484718068, -3000.74587812336, -5251.712385533817],
            [-1.97989570839746e-05, -0.001080027400090759, -0.0007098670173048437],
            [
                -0.1303977224153033,
                -0.9235551691194414,
                0.3606137595567613,
                -0.9835635249313684,
                0.0746803593168579,
                -0.1643947576928366,
                0.1248968631050554,
                -0.3761232424685627,
                -0.9181133263717784,
            ],
        ),
    ];
    let rate = [-1.97989570839746e-05, -0.001134281491669957, 0.0];
    assert_case(
        "10A",
        &Case::new(cylinder(), TYPICAL, &GRADIENT_TYPICAL, rate).with(gradient()),
        &rows,
        1e-4,
    );
}

#[test]
fn run_10c_the_same_on_an_ellipse() {
    let rows = [
        Row(
            60.0,
            [-4298383.754834637, 509016.7255224166, 5242568.014252326],
            [456.8734578034758, -7547.421734780168, 1056.413054103526],
            [-1.958561461497211e-05, -0.00110309563474814, -5.033944725129392e-06],
            [
                -0.6382570985624114,
                -0.0132643224686132,
                0.7697089929864018,
                -0.761764709127885,
                -0.1334104315513559,
                -0.6339685991282135,
                0.1110963728570869,
                -0.9909721058146538,
                0.07504586221284582,
            ],
        ),
        Row(
            480.0,
            [-3640330.276501244, -2599556.727680621, 5092598.761010181],
            [2621.041388769526, -6976.183763440965, -1761.338327952852],
            [-1.958561461497211e-05, -0.0009904878139173603, -3.462817627493608e-05],
            [
                -0.5256679911314227,
                -0.4312470808668893,
                0.7332796999396896,
                -0.7688679268634628,
                -0.1280086312283744,
                -0.6264630087816193,
                0.3640264745049945,
                -0.8931067940480718,
                -0.2642820090067424,
            ],
        ),
        Row(
            28800.0,
            [-1051395.223245429, -6116653.272961161, 2626343.274205685],
            [4747.652816813323, -3014.482597291933, -5262.44273778226],
            [-1.958561461497211e-05, -0.001102150420357001, -0.0007137081527530395],
            [
                -0.1416223422259105,
                -0.9171375917053928,
                0.372561068904521,
                -0.9814677649343182,
                0.08101112610984618,
                -0.1736612329832083,
                0.1290896532541655,
                -0.3902509901681823,
                -0.9116139676943704,
            ],
        ),
    ];
    let rate = [-1.958561461497211e-05, -0.001122059109806593, 0.0];
    let case = Case::new(cylinder(), ELLIPTICAL, &GRADIENT_ELLIPTICAL, rate);
    assert_case("10C", &case.with(gradient()), &rows, 1e-4);
}

/// Cases of the same family without a published row here, against the independent integration only.
#[test]
fn siblings_turning_with_the_local_frame() {
    let turning = [0.0, -RATE, 0.0];
    let torque = push([0.0; 3], [10.0, 0.0, 0.0], 1000.0, 2000.0);
    let both = push([10.0, 0.0, 0.0], [10.0, 0.0, 0.0], 1000.0, 2000.0);
    assert_case("8B", &Case::new(sphere(), TYPICAL, &PITCHED, turning), &[], 1e-4);
    assert_case("9B", &Case::new(station(), TYPICAL, &PITCHED, turning).with(torque), &[], 1e-4);
    assert_case("9D", &Case::new(station(), TYPICAL, &PITCHED, turning).with(both), &[], 1e-4);
}

#[test]
fn siblings_with_a_burn_along_x_and_with_the_gradient_at_inertial_rest() {
    // a burn along the velocity that makes the orbit elliptic, switched off the grid
    let burn = push([29000.0, 0.0, 0.0], [0.0; 3], 1000.25, 1010.75);
    let case = Case::new(cylinder(), TYPICAL, &nadir(&TYPICAL), [0.0, -RATE, 0.0]);
    assert_case("burn along x", &case.with(burn), &[], 1e-3);
    let resting = Case::new(cylinder(), ELLIPTICAL, &GRADIENT_ELLIPTICAL, [0.0; 3]).with(gradient());
    assert_case("10 at rest", &resting, &[], 1e-4);
}
