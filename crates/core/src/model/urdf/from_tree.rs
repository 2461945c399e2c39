//! Deserialization of parsed XML elements into the types of urdf-rs, according to the schema.
//!
//! `urdf_rs::read_from_string` parses its text twice and takes nearly four times as long as loading the whole
//! robot does here. This module fills the types of urdf-rs from the existing XML tree instead, and checks all
//! values while doing so.

use super::element::Element;
use super::error::UrdfError;
use super::refusal::{Refusal, unknown_kind};
use super::schema::{Attribute, attributes, check, elements};
use serde::de::value::{MapDeserializer, StrDeserializer};
use serde::de::{self, DeserializeSeed, Deserializer, EnumAccess, IntoDeserializer, VariantAccess, Visitor};

impl<'a> Element<'a> {
    /// Converts the element to a type of urdf-rs.
    pub(super) fn read<T: de::Deserialize<'a>>(self) -> Result<T, UrdfError> {
        T::deserialize(Value::Element(self)).map_err(|refusal| refusal.at(&self))
    }

    /// Returns the names and values of the fields that the schema lists for this element.
    fn fields(self) -> impl Iterator<Item = (&'static str, Value<'a>)> {
        let is_read = move |name: &str| !self.unread.contains(&name);
        let texts = attributes(self.tag()).iter().filter_map(move |&attribute| {
            let (name, _, default) = attribute;
            let text = self.text(name).filter(|_| is_read(name)).or(default)?;
            Some((name, Value::Text(self, attribute, text)))
        });
        let inside = elements(self.tag()).iter().filter_map(move |&name| {
            let point_mass = (name == "inertia").then_some(Value::Zeros);
            let element = if name == "color" { self.color() } else { self.child(name) };
            let element = element.filter(|_| is_read(name));
            Some((name, element.map(Value::Element).or(point_mass)?))
        });
        texts.chain(inside)
    }
}

/// Value of one field of a urdf-rs type.
enum Value<'a> {
    Element(Element<'a>),
    /// The text of an attribute, or its default.
    Text(Element<'a>, Attribute, &'a str),
    /// A missing element, whose numbers are all zero.
    Zeros,
}

impl<'de> Deserializer<'de> for Value<'de> {
    type Error = Refusal;

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        match self {
            Self::Element(element) => {
                let read = visitor.visit_map(MapDeserializer::new(element.fields()));
                read.map_err(|refusal| Refusal::Placed(refusal.at(&element)))
            }
            Self::Text(element, attribute, text) => {
                check(&element, attribute, text).map_err(Refusal::Placed)?;
                visitor.visit_borrowed_str(text)
            }
            Self::Zeros => visitor.visit_unit(),
        }
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        match self {
            Self::Zeros => visitor.visit_map(MapDeserializer::new(fields.iter().map(|&field| (field, "0")))),
            _ => self.deserialize_any(visitor),
        }
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_some(self)
    }

    /// Deserializes the type of a joint, or the shape in a geometry; of several shapes, the one whose variant
    /// urdf-rs declares first.
    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        match self {
            Self::Element(geometry) => {
                let shape = variants.iter().find_map(|&shape| geometry.child(shape));
                visitor.visit_enum(Shape(shape.ok_or_else(|| {
                    Refusal::Placed(geometry.lacks_element("box>, <sphere>, <cylinder>, <capsule> or <mesh"))
                })?))
            }
            Self::Text(joint, _, text) => {
                let kind = if text == "ball" { "spherical" } else { text };
                if !variants.contains(&kind) {
                    return Err(Refusal::Placed(unknown_kind(&joint, text)));
                }
                visitor.visit_enum(StrDeserializer::new(kind))
            }
            Self::Zeros => visitor.visit_unit(),
        }
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf unit
        unit_struct newtype_struct seq tuple tuple_struct map identifier ignored_any
    }
}

impl<'a> IntoDeserializer<'a, Refusal> for Value<'a> {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

/// Element of a shape, deserialized as an enum: the element name is the variant, and the attributes are its
/// fields.
struct Shape<'a>(Element<'a>);

impl<'a> EnumAccess<'a> for Shape<'a> {
    type Error = Refusal;
    type Variant = Self;

    fn variant_seed<T: DeserializeSeed<'a>>(self, seed: T) -> Result<(T::Value, Self), Refusal> {
        seed.deserialize(StrDeserializer::new(self.0.tag())).map(|variant| (variant, self))
    }
}

impl<'a> VariantAccess<'a> for Shape<'a> {
    type Error = Refusal;

    fn struct_variant<V: Visitor<'a>>(
        self,
        _fields: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        Value::Element(self.0).deserialize_any(visitor)
    }

    fn unit_variant(self) -> Result<(), Refusal> {
        Ok(())
    }

    fn newtype_variant_seed<T: DeserializeSeed<'a>>(self, seed: T) -> Result<T::Value, Refusal> {
        seed.deserialize(Value::Element(self.0))
    }

    fn tuple_variant<V: Visitor<'a>>(self, _length: usize, visitor: V) -> Result<V::Value, Refusal> {
        Value::Element(self.0).deserialize_any(visitor)
    }
}

#[cfg(test)]
mod tests {
    use super::Element;
    use roxmltree::Document;
    use std::fmt::Debug;
    use urdf_rs::{Collision, Inertial, Joint, Mass, Material, Visual};

    /// URDF that contains every field of the schema, to compare the result with that of urdf-rs.
    const ALL: &str = "<robot name='r'><material name='m'><color rgba='0.1 0.2 0.3 1'/></material>
        <link name='a'>
          <inertial><origin xyz='1 2 3' rpy='0.1 0.2 0.3'/><mass value='4'/>
            <inertia ixx='5' ixy='0.6' ixz='0.7' iyy='8' iyz='0.9' izz='10'/></inertial>
          <visual><origin rpy='1 2 3'/><geometry><box size='1 2 3'/></geometry>
            <material name='n'><color rgba='1 0.5 0 0.5'/></material></visual>
          <visual><geometry><mesh filename='a &amp; b.stl' scale='1 1 -1'/></geometry></visual>
          <visual><geometry><mesh filename='b.stl'/></geometry><material name='m'/></visual>
          <collision><geometry><cylinder radius='1' length='2'/></geometry></collision>
          <collision><origin xyz='0 0 1'/><geometry><capsule radius='1' length='2'/></geometry></collision>
          <collision><geometry><sphere radius='3'/></geometry></collision>
        </link><link name='b'/>
        <joint name='j' type='revolute'><parent link='a'/><child link='b'/><origin xyz='1 0 0'/>
          <axis xyz='0 0 -1'/><limit lower='-1' upper='2' velocity='3' effort='4'/>
          <dynamics damping='0.5' friction='0.25'/></joint>
        <joint name='k' type='spherical'><parent link='a'/><child link='b'/>
          <limit lower='-inf' upper='inf' velocity='inf' effort='Infinity'/></joint>
        <joint name='l' type='floating'><parent link='a'/><child link='b'/><limit velocity='1' effort='0'/></joint>
        </robot>";

    fn same<T: serde::de::DeserializeOwned + Debug>(robot: Element<'_>, tag: &'static str, theirs: &[T]) {
        let links = robot.children("link").flat_map(|link| link.children(tag));
        let ours: Vec<T> = robot.children(tag).chain(links).map(|it| it.read().expect("is whole")).collect();
        assert!(!ours.is_empty(), "{tag}");
        assert_eq!(format!("{ours:?}"), format!("{theirs:?}"), "{tag}");
    }

    /// The names of the serde fields of urdf-rs may change between versions; this test then fails.
    #[test]
    fn the_tree_and_urdf_rs_own_reading_give_the_same() {
        let document = Document::parse(ALL).expect("is XML");
        let robot = Element::new(document.root_element(), "");
        let theirs = urdf_rs::read_from_string(ALL).expect("is a URDF");
        same::<Joint>(robot, "joint", &theirs.joints);
        same::<Material>(robot, "material", &theirs.materials);
        let link = &theirs.links[0];
        same::<Inertial>(robot, "inertial", std::slice::from_ref(&link.inertial));
        same::<Visual>(robot, "visual", &link.visual);
        same::<Collision>(robot, "collision", &link.collision);
    }

    #[test]
    fn numbers_keep_their_bits() {
        let edges = [-0.0, 5e-324, 1e-310, f64::MIN_POSITIVE, 0.1, 1e22, f64::MAX, -f64::MAX];
        let drawn = (0..2000_u64).map(|i| f64::from_bits(i.wrapping_mul(0x9E37_79B9_7F4A_7C15)));
        for value in edges.into_iter().chain(drawn.filter(|value| value.is_finite())) {
            for text in [format!("{value:?}"), format!(" {value:e} "), format!("{value}")] {
                let xml = format!("<mass value='{text}'/>");
                let document = Document::parse(&xml).expect("is XML");
                let mass: Mass = Element::new(document.root_element(), "").read().expect("is a number");
                assert_eq!(mass.value.to_bits(), value.to_bits(), "{text}");
            }
        }
    }
}
