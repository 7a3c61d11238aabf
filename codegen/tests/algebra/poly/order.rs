//! Monomial orders agree with those of textbooks.

use hamel_algebra::poly::monomial::Monomial;
use hamel_algebra::poly::order::Order;

fn sorted(order: Order) -> Vec<&'static str> {
    let (x, y, z) = (Monomial::var(0), Monomial::var(1), Monomial::var(2));
    let mut list = [
        ("1", Monomial::one()),
        ("x", x.clone()),
        ("y", y.clone()),
        ("z", z.clone()),
        ("xz", x.mul(&z)),
        ("yy", y.mul(&y)),
        ("xx", x.mul(&x)),
        ("zzz", z.mul(&z).mul(&z)),
    ];
    list.sort_by(|a, b| order.compare(&b.1, &a.1));
    list.map(|entry| entry.0).to_vec()
}

#[test]
fn textbook_orders() {
    let grevlex = ["zzz", "xx", "yy", "xz", "x", "y", "z", "1"];
    assert_eq!(sorted(Order::Grevlex), grevlex);
    let lex = ["xx", "xz", "x", "yy", "y", "zzz", "z", "1"];
    assert_eq!(sorted(Order::Lex), lex);
    let last = ["xx", "xz", "x", "zzz", "yy", "y", "z", "1"];
    assert_eq!(sorted(Order::Block(1)), last);
    let block = ["xx", "yy", "xz", "x", "y", "zzz", "z", "1"];
    assert_eq!(sorted(Order::Block(2)), block);
    assert_eq!(sorted(Order::Block(9)), grevlex);
}
