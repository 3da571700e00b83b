//! The mesh of 17 faces: Table 2 and Fig. 4.

use meshweft::connectivity::{Membership, MinimumTimeRendering, TrimmedListCode};
use serde_json::json;

use super::printed::TABLE_2;
use crate::paper::figure::{Figure, head};

fn faces() -> [[u32; 3]; 17] {
    TABLE_2.map(|(face, _)| face)
}

fn name(membership: Membership) -> &'static str {
    match membership {
        Membership::List => "F1",
        Membership::Previous => "F2",
        Membership::Left => "F_L",
    }
}

fn numbers(vertices: impl IntoIterator<Item = u32>) -> String {
    let texts: Vec<String> = vertices
        .into_iter()
        .map(|vertex| vertex.to_string())
        .collect();
    texts.join(" ")
}

/// The faces in the order in which they are decoded.
pub(super) fn table_2() -> Figure {
    let (code, ..) = TrimmedListCode::new(&faces(), 0);
    let ours: Vec<_> = code.with_memberships().collect();
    let mut rows = vec![head(&["", "paper", "", "ours", ""])];
    let mut json = Vec::new();
    for (number, (printed, found)) in (1..).zip(TABLE_2.iter().zip(&ours)) {
        let [(paper, of_paper), (our, of_our)] = [printed, found];
        rows.push(vec![
            format!("f{number}"),
            numbers(*paper),
            name(*of_paper).to_owned(),
            numbers(*our),
            name(*of_our).to_owned(),
        ]);
        json.push(json!({"face": our, "membership": name(*of_our)}));
    }
    let equal = TABLE_2.iter().zip(&ours).filter(|(a, b)| a == b).count();

    Figure {
        title: format!(
            "The faces of Fig. 1 as they are decoded, and how each is known: {equal} of {} as printed.",
            TABLE_2.len()
        ),
        rows,
        json: json!({"equal": equal, "faces": json}),
    }
}

/// The buffer, vertex by vertex.
pub(super) fn fig_4() -> Figure {
    let faces = faces();
    let rendering = MinimumTimeRendering::new(&faces);
    let drawn = rendering.order().apply(&faces);
    let mut rows = vec![head(&["focus", "sent", "buffer", "faces"])];
    let mut json = Vec::new();
    for (focus, step) in (0_u32..).zip(rendering.steps()) {
        let buffer = focus..step.sent.end;
        let of_step = &drawn[step.faces.start as usize..step.faces.end as usize];
        let texts: Vec<String> = of_step
            .iter()
            .map(|face| format!("({})", numbers(*face)))
            .collect();
        rows.push(vec![
            focus.to_string(),
            numbers(step.sent.clone()),
            numbers(buffer.clone()),
            texts.join(" "),
        ]);
        json.push(json!({"focus": focus, "sent": step.sent.len(), "buffered": buffer.len(), "faces": of_step}));
    }

    Figure {
        title: format!(
            "Fig. 1 drawn through a buffer that takes each vertex once: b = {}, the paper 9.",
            rendering.buffer_size()
        ),
        rows,
        json: json!({"buffer_size": rendering.buffer_size(), "steps": json}),
    }
}
