use super::*;
use proptest::prelude::*;

#[test]
fn a_contour_may_have_a_comment_a_heading_and_any_usual_separator() {
    let expected = vec![DVec2::new(1.0, 2.5), DVec2::new(-3.0, 4.0)];
    for text in [
        "x,y\n1,2.5\n-3,4\n",
        "1 2.5\n-3\t4",
        "# a drawing, not closed\n1;2.5\n\n-3;4\n",
        "\"node\",\"Y\",\"X\"\n0,2.5,1\n1,4,-3\n",
        "x (px), y (px)\n1, 2.5\n-3, 4\n",
        " \tX\tY\r\n1\t1\t2.5\r\n2\t-3\t4\r\n",
        "row,col\n2.5,1\n4,-3\n",
        "index,axis-0,axis-1\n0,2.5,1\n1,4,-3\n",
        "FRAME,POSITION_X,POSITION_Y\n7,1,2.5\n7,-3,4\n",
        "\"x\",\"y\"\n\"1\",\"2.5\"\n\"-3\",\"4\"\n",
        "x,y\n1,2.5,\n-3,4,\n",
        "# contour drawn by hand\n# record of plate 3\n# contour 3 of 7 by hand\n1,2.5\n-3,4\n",
        "x;y\n1;2.5\n-3;4\n\n\n",
        "x y\n1 2.5\n-3 4",
        "x;y\n1,0;2,5\n-3;4,00\n",
        "X\tY\n1,0\t2,5\n-3\t4\n",
    ] {
        let contour = parse_one(text).unwrap_or_else(|e| unreachable!("{text:?}: {e}"));
        assert_eq!(contour, Shape::curve(expected.clone(), None), "{text:?}");
    }
    let open = parse_one("# contour 1, open\n1,2").unwrap();
    assert_eq!(open.closed, Some(false));
}

#[test]
fn columns_origin_and_points_are_as_asked_for() {
    let name = |name: &str| Column::Name(name.to_owned());
    let read = |text: &str, reading: &Reading| {
        let reading = Reading {
            format: Some(Format::Csv),
            ..reading.clone()
        };
        parse_with(text.as_bytes(), &reading)
    };
    let by = |columns| Reading {
        columns: Some(columns),
        ..Reading::default()
    };
    let text = "time,lon,lat,cell\n0,1,2.5,a\n0,3,4,a\n0,5,6,b\n0,7,8,b\n";
    for columns in [
        (name("lon"), name("LAT")),
        (Column::Number(2), Column::Number(3)),
    ] {
        let found = read(text, &by(columns)).unwrap();
        assert_eq!(found.len(), 2);
        assert_eq!(
            found[0].first(),
            [DVec2::new(1.0, 2.5), DVec2::new(3.0, 4.0)]
        );
    }
    let found = read(
        "9 1 2\n9 3 4\n",
        &by((Column::Number(3), Column::Number(2))),
    )
    .unwrap();
    assert_eq!(
        found[0].first(),
        [DVec2::new(2.0, 1.0), DVec2::new(4.0, 3.0)]
    );
    for (columns, says) in [
        ((name("lon"), name("east")), "is not in the heading"),
        (
            (Column::Number(1), Column::Number(5)),
            "is not in the heading",
        ),
        ((Column::Number(0), Column::Number(2)), "numbered from 1"),
    ] {
        let error = read(text, &by(columns)).unwrap_err().to_string();
        assert!(error.contains(says), "{error}");
    }
    let corner = Reading {
        origin: Some(Origin::Corner),
        points: true,
        ..Reading::default()
    };
    let found = read("x,y\n1,2\n3,4\n", &corner).unwrap();
    assert_eq!(
        found,
        [(0.5, 1.5), (2.5, 3.5)].map(|p| Shape::curve(vec![DVec2::from(p)], None))
    );
}

#[test]
fn a_bad_line_is_named_and_not_shown() {
    for (text, message) in [
        ("x,y\n1,2\n3,apple\n", "line 3: two numbers x,y are needed"),
        ("x,y\n1,2\n3\n", "line 3: two numbers x,y are needed"),
        ("1,apple\n1,2", "line 1: two numbers x,y are needed"),
        ("1,NaN", "line 1: numbers must be from -1e9 to 1e9"),
        ("inf,0", "line 1: numbers must be from -1e9 to 1e9"),
        ("0,1e10", "line 1: numbers must be from -1e9 to 1e9"),
        ("x,y\n", "no points"),
        ("", "no points"),
        ("x,y\nx,y\n1,2", "line 2: two numbers"),
        ("12,5;40.5,1\n", "line 1: two numbers x,y are needed"),
        ("1,,2\n", "line 1: more than two entries"),
        ("0,1,2\n1,3,4\n", "line 1: more than two entries"),
        ("x,z\n1,2", "line 1: the heading must name a column y"),
        ("apple\n1,2", "line 1: the heading must name a column x"),
        ("breadth height\n1 2", "line 1: the heading must name"),
        ("x [um],y [um]\n1,2", "line 1: column 1 is in another unit"),
        ("x,y\n109,60,42,00\n", "line 2: more entries than the 2"),
        ("x y\n1 83.0 30.0\n", "line 2: more entries than the 2"),
        ("# contour 2, closed\n1,2", "line 1: this program reads"),
        ("# contour 2\n1,2", "line 1: this program reads"),
        (
            "# record 1, closed\nstep,t,node,x,y\n",
            "line 1: this is the record of a run",
        ),
        ("root:x:0:0:root\n", "line 1: "),
    ] {
        let error = parse_one(text).unwrap_err().to_string();
        assert!(error.starts_with(message), "{text:?}: {error}");
        for secret in ["apple", "root"] {
            assert!(!error.contains(secret), "{text:?}: {error}");
        }
    }
}

#[test]
fn several_curves_are_never_joined_into_one() {
    let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0]].map(DVec2::from_array);
    let other = square.map(|p| p + 10.0);
    for text in [
        "x,y,curve\n0,0,1\n4,0,1\n4,4,1\n10,10,2\n14,10,2\n14,14,2\n",
        // one line of each in turn
        "id,x,y\na,0,0\nb,10,10\na,4,0\nb,14,10\na,4,4\nb,14,14\n",
        "index,axis-0,axis-1\n0,0,0\n0,0,4\n0,4,4\n1,10,10\n1,10,14\n1,14,14\n",
        "0,0\n4,0\n4,4\n\n10,10\n14,10\n14,14\n",
        "x,y\n0,0\n4,0\n4,4\n\nx,y\n10,10\n14,10\n14,14\n",
        "# contour 1\nx,y\n0,0\n4,0\n4,4\n# contour 1\nx,y\n10,10\n14,10\n14,14\n",
    ] {
        let curves = parse(text).unwrap_or_else(|e| unreachable!("{text:?}: {e}"));
        let points: Vec<_> = curves.iter().map(Shape::first).collect();
        assert_eq!(points, [&square[..], &other[..]], "{text:?}");
        let error = parse_one(text).unwrap_err().to_string();
        assert!(error.contains("holds 2 curves"), "{error}");
    }
}

#[test]
fn rings_and_names_are_kept_and_names_that_a_table_cannot_hold_become_numbers() {
    let ring = |at: f64| {
        vec![
            DVec2::splat(at),
            DVec2::new(at + 1.0, at),
            DVec2::new(at, at + 1.0),
        ]
    };
    let shape = |id: &str, rings: Vec<Vec<DVec2>>| Shape {
        id: Some(id.to_owned()),
        closed: Some(true),
        rings,
        ..Shape::default()
    };
    let shapes = vec![
        shape("cell-7", vec![ring(0.0), ring(0.25)]),
        shape("cell-9", vec![ring(5.0)]),
    ];
    let text = to_text(&shapes);
    assert!(
        text.starts_with("# contour 1, closed\nx,y,curve,ring\n0,0,cell-7,0\n"),
        "{text}"
    );
    assert_eq!(parse(&text).unwrap(), shapes);
    for id in ["cell-7", "a,b", "a b", ""] {
        let mut other = shapes.clone();
        other[1].id = Some(id.to_owned());
        let read = parse(&to_text(&other)).unwrap();
        assert_eq!(read[1].id.as_deref(), Some("2"), "{id}");
        assert_eq!(read[1].rings, shapes[1].rings, "{id}");
    }
}

#[test]
fn a_line_of_commas_is_refused_without_a_copy_of_it() {
    let error = parse_one(&",".repeat(1 << 20)).unwrap_err().to_string();
    assert!(error.starts_with("line 1: more than two"), "{error}");
    let error = parse_one(&format!("1,\u{1b}[31m\u{202e}{}", "x".repeat(100_000)));
    let error = error.unwrap_err().to_string();
    assert!(error.len() < 200 && !error.contains('\u{1b}'), "{error}");
}

proptest! {
    #[test]
    fn text_gives_back_the_same_bits(
        points in prop::collection::vec((-1e9..1e9_f64, -1e-3..1e-3_f64), 1..20),
        closed in prop::option::of(any::<bool>()),
    ) {
        let points = points.into_iter().map(|(x, y)| DVec2::new(x, y)).collect();
        let contour = [Shape::curve(points, closed)];
        prop_assert_eq!(parse(&to_text(&contour)).unwrap(), contour);
    }

    #[test]
    fn curves_give_back_the_same_bits(
        curves in prop::collection::vec(
            (prop::collection::vec((-1e9..1e9_f64, -1e3..1e3_f64), 2..9), any::<bool>()),
            2..6,
        ),
    ) {
        let curve = |(i, (points, closed)): (usize, (Vec<(f64, f64)>, bool))| {
            let points = points.into_iter().map(|(x, y)| DVec2::new(x, y)).collect();
            let id = Some((i + 1).to_string());
            Shape { id, ..Shape::curve(points, Some(closed)) }
        };
        let curves: Shapes = curves.into_iter().enumerate().map(curve).collect();
        let read = parse(&to_text(&curves)).unwrap();
        prop_assert_eq!(read, curves);
    }
}
